"""Decoders of one's own, which take part beside the methods of Stipple."""

import ast
from dataclasses import dataclass
from os import PathLike
from typing import Any, Callable, Dict, Iterable, Tuple, Union

import numpy.typing as npt

from ._stipple import Stream

__all__ = ["Decoder"]


@dataclass(frozen=True)
class Decoder:
    """A decoder of one's own as a method of `explore`, `rivals` and `report`; a function alone is a Decoder with its
    name.

    decode: decode(stream, **options) gives the video of a Stream as `stipple.decode` does: an array (slot, row, col),
        of colour (slot, row, col, plane), of finite floating-point light with a frame for each slot. The options are
        the keys "decoder.KEY" of a space. NotImplementedError says that it cannot decode this stream.
    name: its method in tables; by default that of the function.
    version: names what its results depend on besides stream and options. Results of `explore` and `rivals` are known
        again by name and version; without a version each call decodes anew.
    """

    decode: Callable[..., npt.ArrayLike]
    name: str = ""
    version: str = ""

    def __post_init__(self) -> None:
        if not callable(self.decode):
            raise TypeError(f"methods: {self.decode!r} is neither the name of a method nor a function")
        for value in (self.name, self.version):
            if not isinstance(value, str):
                raise TypeError(f"Decoder: {value!r} is not a text")
        if not self.name:
            name = getattr(self.decode, "__name__", type(self.decode).__name__)
            object.__setattr__(self, "name", name)


#: The name of a method, or a decoder of one's own.
Method = Union[str, Decoder, Callable[..., npt.ArrayLike]]


def decoders_of(methods: Iterable[Method]) -> "list[Union[str, Decoder]]":
    if isinstance(methods, str):
        raise TypeError(f"methods: {methods!r} is a text; give a list")
    return [method if isinstance(method, (str, Decoder)) else Decoder(method) for method in methods]


def caller_of(decoder: Decoder) -> Callable[["PathLike[str]", str], npt.ArrayLike]:
    """Of a path and of options as lines of TOML."""

    def call(path: "PathLike[str]", options: str) -> npt.ArrayLike:
        with Stream.open(path) as stream:
            return decoder.decode(stream, **dict(map(_option, options.splitlines())))

    return call


def _option(line: str) -> Tuple[str, Any]:
    key, text = line.split(" = ", 1)
    words: Dict[str, bool] = {"true": True, "false": False}
    return key, words[text] if text in words else ast.literal_eval(text)
