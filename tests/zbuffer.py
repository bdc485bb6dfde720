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
