"""Arrays whose elements are alike: their numbers are read with numpy, by the column.

A path of ten thousand poses is ten thousand times the same few fields, at places that
are equally far from each other. An element becomes an object when it is asked for.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from sambot_viz.errors import DecodeError
from sambot_viz.messages.flat_types import Layout, Leaf, size_of, smallest

_FEWEST = 8
"""Fewer elements are read one by one in less time."""
Read = Callable[[memoryview, int], tuple[Any, int]]
"""Reads what begins somewhere in a message: returns it, and where it ends."""


class Rows(Sequence[Any]):
    """The elements of an array, read when they are asked for.

    Args:
        data: the message.
        first: layout of the first element, which may begin where no other one could.
        second: layout of the second one, and of all that follow.
        stride: bytes from one of these to the next.
        count: of elements, 2 and more.
        read: reads an element.
    """

    def __init__(
        self,
        data: memoryview,
        first: Layout,
        second: Layout,
        stride: int,
        count: int,
        read: Read,
    ) -> None:
        self._data = data
        self._first, self._second = first, second
        self._stride, self._count = stride, count
        self._read = read

    def __len__(self) -> int:
        return self._count

    @overload
    def __getitem__(self, index: int) -> Any: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Any]: ...
    def __getitem__(self, index: int | slice) -> Any:
        if isinstance(index, slice):
            return [self[one] for one in range(*index.indices(self._count))]
        number = range(self._count)[index]
        begin = self._first.begin
        if number:
            begin = self._second.begin + (number - 1) * self._stride
        return self._read(self._data, begin)[0]

    def numbers(self, *paths: str) -> NDArray[np.float64]:
        """Return fields of all elements, (N, number of paths).

        Args:
            paths: of the fields, such as "pose.position.x".

        Raises:
            AttributeError: the elements have no such number.
        """
        # Each field in one piece: they come twice as fast as into the rows of all.
        found = np.empty((len(paths), self._count), np.float64)
        for column, path in enumerate(paths):
            if path not in self._second.numbers:
                raise AttributeError(path)
            place, kind = self._first.numbers[path]
            begin = self._first.begin + place
            found[column, 0] = np.frombuffer(self._data, kind, 1, begin)[0]
            found[column, 1:] = self._rest(*self._second.numbers[path])
        return np.transpose(found)

    def are_uniform(self) -> bool:
        """Return whether all elements but the first have the same texts.

        So it is certain that each of them begins where the one before it ends.
        """
        for begin, end in self._second.texts:
            texts = self._rest(begin, f"V{end - begin}")
            if (texts != texts[0]).any():
                return False
        return True

    def _rest(self, place: int, kind: str) -> NDArray[Any]:
        """Return a field of all elements but the first, (N − 1,)."""
        return np.ndarray(
            (self._count - 1,),
            np.dtype(kind),
            self._data,
            self._second.begin + place,
            (self._stride,),
        )


@dataclass(slots=True)
class ArrayReader:
    """Reads arrays of one type.

    Attributes:
        read: reads an element.
        leaves: what it has in it, at least one.
        order: of the bytes, "<" or ">".
        aligned: whether fields are aligned to their size.
    """

    read: Read
    leaves: Sequence[Leaf]
    order: str
    aligned: bool
    _least: int = field(init=False)
    _largest: int = field(init=False)

    def __post_init__(self) -> None:
        """Compute once what each array needs."""
        self._least = smallest(self.leaves)
        self._largest = max(size_of(kind) for _, kind in self.leaves)

    def __call__(
        self, data: memoryview, at: int, count: int
    ) -> tuple[Sequence[Any], int]:
        """Return the elements that begin somewhere, and where they end.

        Raises:
            DecodeError: there are fewer than `count`.
        """
        if not count:
            return [], at
        if count * self._least > len(data) - at or count > len(data):
            raise DecodeError("an array longer than its message")
        if count >= _FEWEST:
            rows = self._rows(data, at, count)
            if rows is not None:
                return rows
        found: list[Any] = []
        for _ in range(count):
            one, at = self.read(data, self._begin(at))
            found.append(one)
        return found, at

    def _rows(
        self, data: memoryview, at: int, count: int
    ) -> tuple[Sequence[Any], int] | None:
        """Return elements as rows, and where they end; None when they are not alike."""
        first = self._layout(data, at)
        second = self._layout(data, first.end)
        # What reads them one by one has the last word, such as on texts.
        if [one.end for one in (first, second)] != [
            self.read(data, one.begin)[1] for one in (first, second)
        ]:
            return None
        stride = self._begin(second.end) - second.begin
        end = second.end + (count - 2) * stride
        if (self.aligned and stride % self._largest) or end > len(data):
            return None
        rows = Rows(data, first, second, stride, count, self.read)
        return (rows, end) if rows.are_uniform() else None

    def _layout(self, data: memoryview, end: int) -> Layout:
        """Return the layout of the element after another one."""
        return Layout.of(self.leaves, data, self._begin(end), self.order, self.aligned)

    def _begin(self, end: int) -> int:
        size = size_of(self.leaves[0][1]) if self.aligned else 1
        return (end + size - 1) & -size
