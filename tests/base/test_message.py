"""Messages: text that keeps its key through JSON, pickling, copying and naming."""

from __future__ import annotations

import copy
import pickle

import orjson

from lamella.base.message import Message

MESSAGE = Message("cells_large", "3 cell edges are over 4 x the median")


def test_a_message_is_its_text() -> None:
    assert MESSAGE == "3 cell edges are over 4 x the median"
    assert orjson.loads(orjson.dumps([MESSAGE])) == [str(MESSAGE)]
    assert f"warning: {MESSAGE}" == "warning: 3 cell edges are over 4 x the median"


def test_the_key_is_kept() -> None:
    for same in (pickle.loads(pickle.dumps(MESSAGE)), copy.deepcopy(MESSAGE)):
        assert (same, same.key) == (MESSAGE, "cells_large")


def test_of_one_of_several_things() -> None:
    named = MESSAGE.of("the net 'B'")
    assert (named, named.key) == ("the net 'B': 3 cell edges are over 4 x the median", "cells_large")
