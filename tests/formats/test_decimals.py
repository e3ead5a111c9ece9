import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from onbeat.formats.decimals import decimal_rows

printed_before = st.integers(-(10**8), 10**8).map(lambda n: n / 1e6)
numbers = st.floats(-1e6, 1e6) | printed_before | st.sampled_from([0.0, -0.0, -1e-9])


@given(st.lists(st.tuples(numbers, numbers, numbers), min_size=1, max_size=9))
def test_digits_are_those_that_python_prints(rows):
    table = np.array(rows)
    printed = decimal_rows(table).decode()
    wanted = [" ".join(f"{v:.6f}" for v in row) for row in rows]
    for line, expected in zip(printed.splitlines(), wanted, strict=True):
        for ours, theirs in zip(line.split(), expected.split(), strict=True):
            # Halves apart, which binary numbers hardly ever are, every digit is the same; zero has no sign.
            assert ours == theirs.replace("-0.000000", "0.000000") or abs(float(ours) - float(theirs)) < 1.01e-6
            assert not ours.startswith("-0.000000")


@given(st.lists(st.integers(-(10**9), 10**9), min_size=1, max_size=20))
def test_what_was_read_from_six_digits_is_printed_the_same(values):
    texts = [f"{n // 10**6 if n >= 0 else -(-n // 10**6)}.{abs(n) % 10**6:06d}" for n in values]
    signs = ["-" if n < 0 and not t.startswith("-") else "" for n, t in zip(values, texts, strict=True)]
    texts = [sign + t for sign, t in zip(signs, texts, strict=True)]
    assert decimal_rows(np.array([[float(t) for t in texts]])).decode().split() == texts


def test_other_places_separators_and_huge_numbers():
    table = np.array([[1.5, -2.25], [1e20, 3.0]])
    assert decimal_rows(table[:1], 2, ",") == b"1.50,-2.25\n"
    assert decimal_rows(table, 1) == b"1.5 -2.2\n100000000000000000000.0 3.0\n"
    assert decimal_rows(np.zeros((0, 2))) == b""
