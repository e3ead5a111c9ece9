"""Fields of a frozen value that are made when they are first asked for."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Generic, TypeVar, cast, overload

T = TypeVar("T")


class Maker(Generic[T]):
    """How a field is made: a function without arguments."""

    __slots__ = ("_make",)  # a library of many clips has five of them for each

    def __init__(self, make: Callable[[], T]) -> None:
        self._make = make

    def make(self) -> T:
        """Make it."""
        return self._make()


class Lazy(Generic[T]):
    """A field of a dataclass that is given as a value or as a ``Maker`` of it.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> @dataclass(frozen=True)
    ... class Page:
    ...     text: Lazy[str] = Lazy()
    >>> page = Page(Maker(lambda: print("read") or "once"))
    >>> page.text, page.text
    read
    ('once', 'once')
    """

    def __init__(self, default: Callable[[], T] | None = None) -> None:
        self._default = None if default is None else Maker(default)

    def __set_name__(self, owner: type, name: str) -> None:
        """Learn the field's name."""
        self._name = f"_{name}"

    @overload
    def __get__(self, instance: None, owner: type) -> Maker[T]: ...
    @overload
    def __get__(self, instance: object, owner: type) -> T: ...
    def __get__(self, instance: object | None, owner: type) -> T | Maker[T]:
        """The value, made now if it is not there yet; of the class the default, which dataclasses ask for."""
        if instance is None:
            if self._default is None:
                raise AttributeError(self._name)
            return self._default
        values: dict[str, Any] = instance.__dict__
        value = values[self._name]
        if isinstance(value, Maker):
            value = values[self._name] = cast("Maker[T]", value).make()
        return value

    def __set__(self, instance: object, value: T | Maker[T]) -> None:
        """Keep a value, or how it is made."""
        instance.__dict__[self._name] = value
