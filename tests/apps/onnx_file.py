"""Networks as ONNX files, written from the format (onnx.proto3 of github.com/onnx/onnx) with NumPy alone."""

import numpy as np

FLOAT = 1


def _number(value):
    out = bytearray()
    while value > 127:
        out.append(value & 127 | 128)
        value >>= 7
    out.append(value)
    return bytes(out)


def _field(number, value):
    """A whole number, or bytes with their length."""
    if isinstance(value, int):
        return _number(number << 3) + _number(value)
    data = value.encode() if isinstance(value, str) else value
    return _number(number << 3 | 2) + _number(len(data)) + data


def _tensor(name, values):
    values = np.asarray(values, "<f4")
    dims = b"".join(_field(1, size) for size in values.shape)
    return dims + _field(2, FLOAT) + _field(8, name) + _field(9, values.tobytes())


def _value(name, shape):
    """A size that is a text is free."""
    dims = b"".join(_field(1, _field(2 if isinstance(size, str) else 1, size)) for size in shape)
    return _field(1, name) + _field(2, _field(1, _field(1, FLOAT) + _field(2, dims)))


def _integers(name, values):
    return _field(1, name) + b"".join(_field(8, value) for value in values) + _field(20, 7)


def convolution(weights, shape=("batch", None, "rows", "cols")):
    """A network of one layer, which keeps the size: weights (outputs, inputs, rows, cols), both odd."""
    outputs, inputs, rows, cols = np.shape(weights)
    pads = [rows // 2, cols // 2] * 2
    node = (_field(1, "frames") + _field(1, "weights") + _field(2, "clean") + _field(4, "Conv")
            + _field(5, _integers("kernel_shape", [rows, cols])) + _field(5, _integers("pads", pads)))
    sizes = [inputs if size is None else size for size in shape]
    graph = (_field(1, node) + _field(2, "net") + _field(5, _tensor("weights", weights))
             + _field(11, _value("frames", sizes)) + _field(12, _value("clean", [sizes[0], outputs, *sizes[2:]])))
    return _field(1, 7) + _field(7, graph) + _field(8, _field(2, 11))
