"""Any sound becomes ticks; what is wrong with it is said once and once more when it is over."""

from __future__ import annotations

import numpy as np
import pytest

from faulty_source import Fault, Kind, faulty
from onbeat.errors import AudioError
from onbeat.live.sound.ears import EAR_RATE, TICK, Ears

RATE = EAR_RATE


def tone(seconds: float, rate: int = RATE, level: float = 0.5) -> np.ndarray:
    return (level * np.sin(2 * np.pi * 440.0 * np.arange(round(seconds * rate)) / rate)).astype(np.float32)


def heard(blocks: list[tuple[np.ndarray, int]], ears: Ears | None = None) -> np.ndarray:
    ears, ticks = ears or Ears(), []
    for block, rate in blocks:
        ears.take(block, rate)
        while (tick := ears.tick()) is not None:
            ticks.append(tick)
    return np.concatenate(ticks) if ticks else np.zeros(0, np.float32)


@pytest.mark.parametrize("rate", [4000, 8000, 44100, 48000, 96000, 400000])
@pytest.mark.parametrize("channels", [0, 2, 6, 64])
def test_any_rate_and_number_of_channels_is_heard_alike(rate: int, channels: int):
    if channels > 6 and rate > 48000:
        pytest.skip("as the others, and slow")
    sound = tone(1.0, rate)
    blocks = [(part if not channels else np.tile(part[:, None], channels), rate) for part in np.array_split(sound, 100)]
    out = heard(blocks)
    assert len(out) >= RATE - 3 * TICK
    middle = slice(RATE // 4, RATE // 4 + RATE // 2)
    assert np.abs(out[middle] - tone(1.0)[middle]).max() < 0.02


@pytest.mark.parametrize("kind", ["int16", "int32", "uint8", "int8", "float64", "float32", "float16"])
def test_whatever_type_devices_give(kind: str):
    sound = tone(0.3).astype(np.float64)
    if kind[0] in "iu":
        limits = np.iinfo(kind)
        sound = sound * limits.max if kind[0] == "i" else (sound + 1.0) * 128
    out = heard([(part.astype(kind), RATE) for part in np.array_split(sound, 30)])
    assert np.abs(out[4410:] - tone(0.3)[4410 : len(out)]).max() < 0.03


def test_channels_that_are_silent_do_not_make_it_quieter():
    sound = np.zeros((RATE // 2, 32), np.float32)
    sound[:, 17] = tone(0.5)
    out = heard([(part, RATE) for part in np.array_split(sound, 50)])
    assert np.abs(out).max() == pytest.approx(0.5, abs=0.02)


@pytest.mark.parametrize(
    ("kind", "begins", "over"),
    [
        ("nan", "not-a-number", "numbers again"),
        ("inf", "not-a-number", "numbers again"),
        ("dc", "constant offset", "is gone"),
        ("clip", "clips: turn", "clips no more"),
        ("gone", "no sound comes", "there again"),
        ("8k", "8000 samples a second now", "44100 samples a second now"),
        ("96k", "96000 samples a second now", "44100 samples a second now"),
    ],
)
def test_a_fault_is_said_once_and_once_more_when_it_is_over(kind: Kind, begins: str, over: str):
    ears, said, ticks = Ears(), list[str](), []
    rng = np.random.default_rng(1)
    song = (0.1 * rng.standard_normal(12 * RATE)).astype(np.float32)
    for blocks in faulty(song, RATE, [Fault(kind, 1.0, 6.5)]):
        for block, rate in blocks:
            ears.take(block, rate)
        ticks.append(ears.tick())
        said += ears.problems()
    assert [begins in said[0], over in said[1], len(said)] == [True, True, 2], said
    sound = np.concatenate([tick for tick in ticks if tick is not None])
    assert np.isfinite(sound).all()
    assert np.abs(sound).max() <= 1.0
    assert abs(sound[-RATE:].mean()) < 0.01


def test_clean_sound_that_is_loud_is_not_complained_of():
    ears = Ears()
    heard([(part, RATE) for part in np.array_split(tone(4.0, level=0.99), 400)], ears)
    assert ears.problems() == []


def test_who_does_not_ask_in_time_gets_the_newest_two_seconds():
    ears = Ears()
    sound = np.concatenate((np.zeros(3 * RATE, np.float32), tone(2.0)))
    for part in np.array_split(sound, 7):
        ears.take(part, RATE)
    ticks = [ears.tick() for _ in range(201)]
    assert [tick is None for tick in ticks] == [False] * 200 + [True]
    assert np.abs(ticks[0]).max() > 0.4
    assert ears.dropped == 3 * RATE
    assert ["too late" in text for text in ears.problems()] == [True]


def test_a_block_of_an_hour_costs_no_more_than_its_end():
    ears = Ears()
    ears.take(np.broadcast_to(np.float32(0.1), (3600 * 48000, 2)), 48000)
    assert ears.dropped == 3598 * RATE


def test_the_same_blocks_give_the_same_bits():
    rng = np.random.default_rng(2)
    blocks = [(rng.standard_normal((480, 2)), 48000) for _ in range(30)]
    assert np.array_equal(heard(blocks), heard(blocks))


def test_rates_that_change_all_the_time_are_gone_along_with():
    ears = Ears()
    out = heard([(tone(0.01, rate), rate) for rate in [48000, 8000, 44100, 96000] * 25], ears)
    assert len(out) == pytest.approx(RATE, abs=0.02 * RATE)
    assert len(ears.problems()) <= 1


@pytest.mark.parametrize(
    ("block", "rate"),
    [
        (np.zeros((10, 65)), RATE),
        (np.zeros((10, 0)), RATE),
        (np.zeros((2, 10, 2)), RATE),
        (np.array(["a"]), RATE),
        (np.zeros(10, complex), RATE),
        (np.zeros(10), 0),
        (np.zeros(10), 10**9),
        (np.zeros(10), float("nan")),
    ],
)
def test_what_is_no_sound_is_refused_and_changes_nothing(block: np.ndarray, rate: int):
    ears = Ears()
    with pytest.raises(AudioError, match="expected"):
        ears.take(block, rate)
    assert np.abs(heard([(tone(0.5), RATE)], ears)).max() > 0.4


def test_huge_and_empty_blocks_are_no_trouble():
    out = heard([(np.zeros((0, 2)), RATE), (np.full(TICK, 1e300), RATE), (np.full(TICK, -1e300), RATE)])
    assert np.abs(out).max() <= 1.0
