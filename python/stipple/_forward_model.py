"""The forward model as an operator: y = A x + noise."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any, Callable, Optional, Tuple, TypeVar, Union

import numpy as np
import numpy.typing as npt

from . import _stipple
from ._stipple import Sensor, Stream

if TYPE_CHECKING:
    from os import PathLike

Name = Union[str, "PathLike[str]"]
Array = npt.NDArray[np.float32]
Value = TypeVar("Value", bound=np.generic)


def _array(value: Any, name: str) -> Array:
    """float32, C-contiguous, a view where that is possible: of arrays, and of what speaks DLPack."""
    if not isinstance(value, np.ndarray) and hasattr(value, "__dlpack__"):
        try:
            value = np.from_dlpack(value)
        except (BufferError, RuntimeError, TypeError) as error:
            raise ValueError(f"{name}: cannot be read as an array of this machine's memory: {error}") from error
    array = np.asarray(value)
    if array.dtype.kind not in "fiub":
        raise ValueError(f"{name}: {array.dtype} is not a real number")
    return np.ascontiguousarray(array, dtype=np.float32)


class ForwardModel:
    """What a coded-exposure chip measures of light x: y = A x + noise.

    source: a Stream or the path of one, whose samples it has; or a Schedule, or the name or path of one,
        for `sensor` and `shape`.
    sensor: a Sensor, or the name or path of one; of a schedule only.
    shape: (slots, rows, columns) or (slots, rows, columns, planes); of a schedule only.
    first_slot, slots: the window of a stream, at most 128 slots; by default as many as there are.

    Arrays x have that shape (`shape`), in units of light (1.0 is the sensor's photons_per_unit in a slot).
    A sample is the light of the open slots of an exposure; arrays y have the shape of x, and a sample
    stands in the last slot of its exposure (`is_sample`), other values are 0. Exposures that reach beyond
    the window have none. Leading axes are batches. Arrays are float32; others are converted. Results have
    the same bits for any number of threads. What is wrong raises ValueError.
    """

    def __init__(
        self,
        source: Union[Stream, _stipple.Schedule, Name],
        sensor: Union[Sensor, Name, None] = None,
        shape: Optional[Tuple[int, ...]] = None,
        *,
        first_slot: int = 0,
        slots: Optional[int] = None,
    ) -> None:
        if shape is None and sensor is None:
            if isinstance(source, _stipple.Schedule):
                raise ValueError("shape: a schedule needs a sensor and (slots, rows, columns)")
            stream = source if isinstance(source, Stream) else Stream.open(source)
            if first_slot < 0:
                raise ValueError(f"first_slot: {first_slot} is below 0")
            self._model = _stipple.ForwardModel.of_stream(stream, first_slot, slots)
        else:
            if isinstance(source, Stream):
                raise ValueError("shape: a stream has its own sensor and shape")
            if shape is None or len(shape) not in (3, 4):
                raise ValueError(f"shape: {shape} is not (slots, rows, columns) or (slots, rows, columns, planes)")
            sensor = "paper" if sensor is None else sensor
            self._model = _stipple.ForwardModel.of_sensor(source, sensor, (*shape, 1)[:4])
        self._planar = self._model.planes() > 1

    @classmethod
    def _of(cls, model: _stipple.ForwardModel) -> ForwardModel:
        made = cls.__new__(cls)
        made._model, made._planar = model, model.planes() > 1
        return made

    def _view(self, array: npt.NDArray[Value]) -> npt.NDArray[Value]:
        """As users have it: planes last."""
        return np.moveaxis(array, -3, -1) if self._planar else array

    def _call(self, operation: Callable[[Array], Any], value: Any, name: str) -> Any:
        """Of each array of a batch."""
        array = np.asarray(value) if isinstance(value, np.ndarray) else _array(value, name)
        if self._planar and array.ndim >= 4:
            array = np.moveaxis(array, -1, -3)
        array = _array(array, name)
        size = self._model.shape()
        if array.ndim <= len(size):
            return operation(array)
        batch = array.shape[: -len(size)]
        results = [operation(one) for one in array.reshape(-1, *array.shape[-len(size):])]
        return np.asarray(results).reshape(batch + np.shape(results[0]) if results else batch)

    @property
    def shape(self) -> Tuple[int, ...]:
        """(slots, rows, columns), or (slots, rows, columns, planes)."""
        return self._view(np.empty(self._model.shape(), dtype=np.bool_)).shape

    @property
    def y(self) -> Array:
        """The samples; those of DN 0 half a DN higher, as they are bounds."""
        return self._view(self._model.samples())

    @property
    def is_sample(self) -> npt.NDArray[np.bool_]:
        """Where y has a sample."""
        return self._view(self._model.is_sample())

    @property
    def is_saturated(self) -> npt.NDArray[np.bool_]:
        """Where the light of a sample is y or more."""
        return self._view(self._model.is_saturated())

    @property
    def is_zero(self) -> npt.NDArray[np.bool_]:
        """Where a sample is DN 0: its light is y or less."""
        return self._view(self._model.is_zero())

    @property
    def variance(self) -> Array:
        """Variance of each sample that `prox` uses: of the light of the sample itself, or as set_variance says."""
        return self._view(self._model.variances())

    def set_y(self, y: Any) -> None:
        """Replaces the samples; none of them is a bound then."""
        self._call(self._model.set_samples, y, "y")

    def set_variance(self, x: Any) -> None:
        """The variances become those of the light of an estimate."""
        self._call(self._model.set_variances, x, "x")

    def forward(self, x: Any) -> Array:
        """A x: the light of each exposure."""
        return self._view(self._call(self._model.forward, x, "x"))

    def adjoint(self, y: Any) -> Array:
        """A^T y: each open voxel has its weight times the value of its exposure."""
        return self._view(self._call(self._model.adjoint, y, "y"))

    def prox(self, v: Any, step: Any) -> Array:
        """Proximal map of the data term, argmin_x |x - v|^2 / (2 step) + sum (y - A x)^2 / (2 variance), in closed
        form. Bounds move only light that breaks them. step: a number, or an array (slot, row, column)."""
        steps = _array(step, "step")
        return self._view(self._call(lambda one: self._model.prox(one, steps), v, "v"))

    def noise_variance(self, x: Any) -> Array:
        """Variance of each sample if the light is x: shot noise, read noise, rounding."""
        return self._view(self._call(self._model.noise_variance, x, "x"))

    def log_likelihood(self, x: Any) -> Any:
        """log p(y | x): normal, and of bounds the logarithm of their probability. One number for each video."""
        return self._call(self._model.log_likelihood, x, "x")

    def score(self, x: Any) -> Array:
        """Gradient of log_likelihood; the variances change with x, too."""
        return self._view(self._call(self._model.score, x, "x"))

    # As DeepInverse calls them.
    A = forward
    A_adjoint = adjoint

    def prox_l2(self, z: Any, y: Any, gamma: float) -> Array:
        """As DeepInverse has it: prox of gamma |A x - y|^2 / 2 at z, without weights of noise and without bounds."""
        samples, gain = _array(y, "y"), self.forward(self.adjoint(self.is_sample))
        if not isinstance(gamma, (int, float)) or not gamma >= 0:
            raise ValueError(f"gamma: {gamma} is not a number from 0 on")
        residual = np.where(self.is_sample, samples - self.forward(z), 0)
        return _array(z, "z") + gamma * self.adjoint(residual / (1 + gamma * gain))

    def as_linear_operator(self) -> Any:
        """A scipy.sparse.linalg.LinearOperator from the voxels to the samples, in the order of y[is_sample]."""
        is_sample, shape = self.is_sample, self.shape

        def spread(samples: Array) -> Array:
            y = np.zeros(shape, dtype=np.float32)
            y[is_sample] = samples.ravel()
            return self.adjoint(y).ravel()

        return _module("scipy.sparse.linalg", "SciPy").LinearOperator(
            (int(is_sample.sum()), int(np.prod(shape))),
            matvec=lambda x: self.forward(x.reshape(shape))[is_sample],
            rmatvec=spread,
            dtype=np.float32,
        )

    def torch(self, x: Any) -> Any:
        """A x of a torch tensor, batches and gradients included. Needs PyTorch (Debian: python3-torch)."""
        return _apply(self.forward, self.adjoint, x)

    def torch_log_likelihood(self, x: Any) -> Any:
        """log_likelihood of a torch tensor, with gradients."""

        def back(x: Array, gradient: Array) -> Array:
            return self.score(x) * gradient.reshape(gradient.shape + (1,) * len(self.shape))

        return _apply(self.log_likelihood, back, x, keeps=True)


def _module(name: str, product: str) -> Any:
    """A module that is not needed otherwise."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ImportError(f"{product} is not installed (Debian: python3-{name.split('.')[0]})") from error


def _apply(forward: Callable[..., Any], backward: Callable[..., Any], x: Any, keeps: bool = False) -> Any:
    """forward as a function of PyTorch; backward(gradient), or backward(x, gradient) if it `keeps` x."""
    torch = _module("torch", "PyTorch")
    if not isinstance(x, torch.Tensor):
        raise ValueError(f"x: {type(x).__name__} is not a torch tensor")
    if x.device.type != "cpu":
        raise ValueError(f"x: is on {x.device}; the forward model runs on the CPU: x.cpu()")

    class Function(torch.autograd.Function):  # type: ignore[misc, name-defined]
        @staticmethod
        def forward(context: Any, x: Any) -> Any:
            if keeps:
                context.save_for_backward(x)
            return torch.as_tensor(np.asarray(forward(x.detach().numpy())), dtype=x.dtype)

        @staticmethod
        def backward(context: Any, gradient: Any) -> Any:
            kept = [x.detach().numpy() for x in context.saved_tensors]
            return torch.as_tensor(np.asarray(backward(*kept, gradient.detach().numpy())), dtype=gradient.dtype)

    return Function.apply(x)
