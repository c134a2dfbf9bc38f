"""Elliptic functions against mpmath at 30 digits.

1. at the argument where scipy's ellipeinc is wrong; 2. at random arguments of several periods and thin necks.
"""

import mpmath
import numpy as np
import pytest

from lamella.surface.closed_forms.elliptic import epsilon, first_kind, jacobi, quarter_period

mpmath.mp.dps = 30


def test_second_kind_where_scipy_fails():
    phi, m = 0.4125760989875492, 0.7975
    x = float(mpmath.ellipf(phi, m))
    f = jacobi(np.array([x]), 1 - m)
    assert epsilon(np.array([x]), f, 1 - m)[0] == pytest.approx(float(mpmath.ellipe(phi, m)), abs=1e-14)


@pytest.mark.parametrize("m1", [1.0, 0.7, 0.1, 1e-3, 1e-6])
def test_jacobi_and_epsilon(m1):
    rng = np.random.default_rng(3)
    quarter = quarter_period(m1)
    x = rng.uniform(-9 * quarter, 9 * quarter, 60)
    f = jacobi(x, m1)
    e = epsilon(x, f, m1)
    m = 1 - mpmath.mpf(m1)
    for i, xi in enumerate(x):
        assert f.sn[i] == pytest.approx(float(mpmath.ellipfun("sn", xi, m=m)), abs=2e-13)
        assert f.cn[i] == pytest.approx(float(mpmath.ellipfun("cn", xi, m=m)), abs=2e-13)
        assert f.dn[i] == pytest.approx(float(mpmath.ellipfun("dn", xi, m=m)), rel=1e-9)
        am = mpmath.asin(mpmath.ellipfun("sn", xi, m=m))
        turns = round(float(xi) / (2 * quarter))
        exact = (-1) ** turns * mpmath.ellipe(am, m) + 2 * turns * mpmath.ellipe(m)
        assert e[i] == pytest.approx(float(exact), abs=1e-12)


def test_first_kind():
    for sine in (-0.999, -0.3, 0.0, 0.5, 1.0):
        exact = float(mpmath.ellipf(mpmath.asin(sine), 0.5))
        assert first_kind(np.array([sine]), 0.5)[0] == pytest.approx(exact, abs=1e-14)
