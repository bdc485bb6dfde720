"""A z-buffer of spheres, and the comparison of a picking mask with it."""

import numpy as np

from molviz.model.spheres import Spheres


def zbuffer(spheres: Spheres, low: np.ndarray, pixel: float, shape: tuple[int, int]) -> np.ndarray:
    """Labels (h, w): the row of the sphere nearest the eye at each pixel centre, −1 for none; row 0 is the top.

    ``low`` is the lower left corner of the image in ångström, ``pixel`` the size of a pixel.
    """
    height, width = shape
    depth = np.full(shape, -np.inf)
    label = np.full(shape, -1)
    for row, (center, radius) in enumerate(zip(spheres.center, spheres.radius, strict=True)):
        left, bottom = np.floor((center[:2] - radius - low) / pixel).astype(int)
        right, top = np.ceil((center[:2] + radius - low) / pixel).astype(int)
        columns, lines = np.arange(max(left, 0), min(right, width)), np.arange(max(bottom, 0), min(top, height))
        x, y = low[0] + (columns + 0.5) * pixel - center[0], low[1] + (lines + 0.5) * pixel - center[1]
        square = radius**2 - x[None, :] ** 2 - y[:, None] ** 2
        window = np.ix_(height - 1 - lines, columns)
        z = np.where(square > 0, center[2] + np.sqrt(np.maximum(square, 0)), -np.inf)
        nearer = z > depth[window]
        depth[window] = np.where(nearer, z, depth[window])
        label[window] = np.where(nearer, row, label[window])
    return label


def entry(center: np.ndarray, radius: np.ndarray, ray: np.ndarray) -> np.ndarray:
    """How far from an eye at the origin rays (…, 3) of any length enter a ball; inf where they pass it by."""
    unit = ray / np.linalg.norm(ray, axis=-1, keepdims=True)
    along = (unit * center).sum(-1)
    square = radius**2 - ((unit * along[..., None] - center) ** 2).sum(-1)
    return np.where((square > 0) & (along > 0), along - np.sqrt(np.maximum(square, 0)), np.inf)


def image_boxes(spheres: Spheres, distance: float) -> tuple[np.ndarray, np.ndarray]:
    """Lower left and upper right corners (n, 2) of the balls' images on a page through the origin of the view.

    In the plane of the eye and one axis of the page a ball is seen from ``φ − ψ`` to ``φ + ψ``: its disc there, tan φ
    = x / depth and sin ψ = r / √(x² + depth²).
    """
    flat, depth = spheres.center[:, :2], (distance - spheres.center[:, 2])[:, None]
    middle, half = np.arctan2(flat, depth), np.arcsin(spheres.radius[:, None] / np.hypot(flat, depth))
    return distance * np.tan(middle - half), distance * np.tan(middle + half)


def central_zbuffer(
    spheres: Spheres, low: np.ndarray, pixel: float, shape: tuple[int, int], distance: float
) -> np.ndarray:
    """The same from an eye at ``distance`` up the z axis: one ray a pixel, through the page at z = 0."""
    height, width = shape
    depth, label = np.full(shape, np.inf), np.full(shape, -1)
    x = low[0] + (np.arange(width) + 0.5) * pixel
    y = low[1] + (height - np.arange(height) - 0.5) * pixel
    for row, (corner, opposite) in enumerate(zip(*image_boxes(spheres, distance), strict=True)):
        columns = np.flatnonzero((x > corner[0]) & (x < opposite[0]))
        lines = np.flatnonzero((y > corner[1]) & (y < opposite[1]))
        ray = np.stack([*np.meshgrid(x[columns], y[lines]), np.full((len(lines), len(columns)), -distance)], axis=-1)
        far = entry(spheres.center[row] - [0, 0, distance], spheres.radius[row], ray)
        window = np.ix_(lines, columns)
        nearer = far < depth[window]
        depth[window] = np.where(nearer, far, depth[window])
        label[window] = np.where(nearer, row, label[window])
    return label


def interior(label: np.ndarray) -> np.ndarray:
    """Pixels whose eight neighbours carry the same label: farther than a pixel from any boundary."""
    inner = np.zeros(label.shape, dtype=bool)
    middle = label[1:-1, 1:-1]
    inner[1:-1, 1:-1] = np.all(
        [label[1 + dy : label.shape[0] - 1 + dy, 1 + dx : label.shape[1] - 1 + dx] == middle
         for dx in (-1, 0, 1) for dy in (-1, 0, 1)],
        axis=0,
    )  # fmt: skip
    return inner


def mask_labels(image: np.ndarray) -> np.ndarray:
    """Rows of the spheres from the colours of a picking mask (h, w, 3 or 4); white or transparent is −1."""
    rgb = image[..., :3].astype(int)
    label = (rgb[..., 0] << 16 | rgb[..., 1] << 8 | rgb[..., 2]) - 1
    empty = image[..., 3] == 0 if image.shape[2] == 4 else label == 0xFFFFFF - 1
    return np.where(empty, -1, label)
