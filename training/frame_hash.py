"""Difference hashes of frames (Krawetz 2013), by which a test sees that nothing of the evaluation is trained on."""

import numpy as np

ROWS, COLS = 8, 9


def frame_hashes(video):
    """64 bits of each frame of a video (slot, row, col): in each of 8 rows whether a ninth is lighter than the one to
    its left. Frames that differ in size, light, compression or noise have nearly the same bits."""
    means = np.asarray(video, np.float32)
    for axis, parts in ((1, ROWS), (2, COLS)):
        size = means.shape[axis]
        begins = np.arange(parts) * size // parts
        lengths = np.diff(begins, append=size).reshape(-1, *[1] * (2 - axis))
        means = np.add.reduceat(means, begins, axis) / lengths
    return np.packbits((np.diff(means, axis=2) > 0).reshape(len(means), -1), axis=1)


def least_distance(some, others):
    """The smallest number of bits in which a frame of `some` differs from one of `others`."""
    return int(np.unpackbits(some[:, np.newaxis] ^ others, axis=2).sum(2).min())
