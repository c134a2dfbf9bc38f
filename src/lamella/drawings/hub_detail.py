"""Details of the hubs of singular nodes: seen from above with the angles between their rays, and cut along one."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lamella.base.arrays import Floats
from lamella.drawings.built import Built, hardware_near, strips_near
from lamella.drawings.joint_detail import DETAIL_BORDER, LEGEND, draw_cut, draw_top
from lamella.drawings.page import HEAD_EM, TEXT_EM, Page
from lamella.drawings.paper import Paper, scale_text, standard_scale
from lamella.drawings.terms import Terms
from lamella.drawings.view import View
from lamella.fabrication.flat import outline_points
from lamella.hardware.item import Item


def hub_pages(built: Built, paper: Paper, words: Terms) -> Iterator[Page]:
    """A sheet for each hub: its fins stand on one node."""
    fins = [item for item in built.hardware if item.kind == "hub fin"]
    hubs = dict.fromkeys(tuple(np.round(origin, 9).tolist()) for item in fins for origin in item.places.origins)
    for centre in hubs:
        of_hub = [item for item in fins if np.abs(item.places.origins - centre).max() < 1e-6]
        yield _page(built, paper, words, np.array(centre), of_hub)


def _page(built: Built, paper: Paper, words: Terms, centre: Floats, fins: list[Item]) -> Page:
    rays = np.concatenate([item.places.axes[:, 0] for item in fins])
    nearest = int(np.argmin(np.linalg.norm(built.network.node_points - centre, axis=1)))
    normal = built.network.node_normals[nearest]
    # the first ray of the list; the normal of the view is the node's
    x = rays[0] - rays[0] @ normal * normal
    x /= np.linalg.norm(x)
    frame = np.stack([x, np.cross(normal, x), normal])
    reach = 1.1 * max(float(np.abs(outline_points(item.cut.outline)[:, 0]).max()) for item in fins)
    radius = float(np.hypot(2**0.5 * reach, built.lamellas.section.height))
    pieces = [*hardware_near(built, centre, radius), *strips_near(built, centre, radius)]
    name = fins[0].id.rpartition("-fin")[0] or fins[0].id
    page = Page(f"{words('hub_detail', hub=name)}: {words('at_node', node=nearest)}")
    left, low, right, high = paper.room
    split = left + (right - left - LEGEND) / 2
    room = min(split - left, high - low) - 3 * DETAIL_BORDER
    scale = standard_scale((2 * reach, 2 * reach), (room, room - HEAD_EM))
    page.scale = scale_text(scale)
    above = draw_top(page, words, pieces, (centre, frame), reach, (left, low, split, high), scale)
    beside = draw_cut(page, words, pieces, (centre, frame), reach, (split, low, right, high), scale, words("side_view"))
    _angles(page, words, above, centre, frame, rays, reach)
    _sizes(page, words, beside, fins[0], (reach, built.lamellas.section.height / 2))
    return page


def _sizes(page: Page, words: Terms, view: View, fin: Item, shown: tuple[float, float]) -> None:
    """Length and height of the fin that is seen from its side; half of the width and the height that are shown, m."""
    corners = outline_points(fin.cut.outline)
    least, most = corners.min(axis=0), corners.max(axis=0)
    origin, axes = fin.places.origins[0], fin.places.axes[0, :2]
    below = origin + np.array([[least[0], least[1]], [most[0], least[1]]]) @ axes
    beside = origin + np.array([[most[0], least[1]], [most[0], most[1]]]) @ axes
    down = shown[1] * view.mm + float((view.place(below) - view.at)[0, 1]) + DETAIL_BORDER * 0.8
    view.dimension(page, words, below, -np.copysign(down, axes[1] @ view.axes[1]))
    right = shown[0] * view.mm - float((view.place(beside) - view.at)[0, 0]) + DETAIL_BORDER * 0.5
    view.dimension(page, words, beside, -right)


def _angles(page: Page, words: Terms, view: View, centre: Floats, frame: Floats, rays: Floats, reach: float) -> None:
    """Angles between neighbouring rays, seen along the normal."""
    flat = rays @ frame[:2].T
    angles = np.sort(np.arctan2(flat[:, 1], flat[:, 0]) % (2 * np.pi))
    between = np.diff(np.append(angles, angles[0] + 2 * np.pi))
    radius = 1.42 * reach * view.mm
    at = view.place(centre)
    for start, turn in zip(angles.tolist(), between.tolist(), strict=True):
        arc = start + np.linspace(0.0, turn, 25)
        page.line(at + radius * np.column_stack([np.cos(arc), np.sin(arc)]), "thin")
        ray = np.array([np.cos(start), np.sin(start)])
        page.line([at + 1.02 * reach * view.mm * ray, at + (radius + 2) * ray], "thin")
        middle = start + turn / 2
        x, y = (at + (radius + 4) * np.array([np.cos(middle), np.sin(middle)])).tolist()
        text = f"{words.number(np.degrees(turn), 1)}°"
        page.label(text, x, y - TEXT_EM / 3, TEXT_EM, anchor="middle")
