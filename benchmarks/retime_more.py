"""Of retiming: beats kept, time taken, plans made as the music happens, and what the paper shows, as numbers."""

from __future__ import annotations

import time
from collections.abc import Sequence
from functools import partial

import numpy as np
from scipy.signal import butter, sosfiltfilt

from onbeat.limits.limits import Limits
from onbeat.motion.joint_angles import JointAngles
from onbeat.retime.bspline import Spline
from onbeat.retime.controlpoints import fit
from onbeat.retime.demand import Demand, Method
from onbeat.retime.lock import TimeMap
from onbeat.retime.measures import measure
from onbeat.retime.meeting import meet
from onbeat.retime.methods import METHODS
from onbeat.retime.pollard2002 import follow
from onbeat.retime.sources import Table
from onbeat.retime.stream import Follower
from retime_dances import FPS, Dance
from retime_peers import lag_of_toppra

FINE = 4.0  # [Hz] above which a joint's velocity is detail


def silent(share: float) -> None:
    del share


def choices(dances: Sequence[tuple[Dance, Limits]]) -> None:
    """What the constants of a baseline and of ours were chosen by: means over joints that are past a limit, 1.0 ×."""
    print("\nChoices, on the arms (HRP-4C's table and 1.45 × base layer together)")

    def told(name: str, make: Method, to_speed: float = 0.05) -> None:
        rms, peak, worst = list[np.ndarray](), list[np.ndarray](), 0.0
        for dance, limits in dances:
            demand = dance.demand(limits.with_acceleration(to_speed), 1.0)
            past = demand.violated(demand.wish.controls, derivatives=False).any(axis=0)
            found = measure(demand, make(demand, silent).trajectory)
            rms.append(found.rms[past])
            peak.append(found.peak_acceleration[past])
            worst = max(worst, found.worst_keypose)
        figures = np.degrees(np.concatenate(rms).mean()), np.concatenate(peak).mean(), np.degrees(worst)
        print(f"  {name:44} rms {figures[0]:5.2f}°, peak {figures[1]:5.0f} rad/s², worst keypose {figures[2]:5.2f}°")

    for stiffness in (10, 50, 100, 200, 400, 800, 1600, 3200):
        told(f"Pollard's k, {stiffness} 1/s²", partial(follow, stiffness=stiffness))
    for to_speed in (0.1, 0.07, 0.05, 0.03, 0.01):
        told(f"qp, rest to full speed in {to_speed:g} s", fit, to_speed)


def sync(dances: Sequence[tuple[Dance, Limits]]) -> None:
    """How late the last beat of a dance is: danced by its frames on a drifting music, and by TOPP-RA."""
    print("\nThe last beat of a dance of 30 s or more, in ms late (one frame is 16.7 ms)")
    print(f"  {'dance, limits':44} {'qp, 1.2 ×':>10} {'drifting':>10} {'TOPP-RA, 1.0 × and 1.2 ×':>26}")
    for dance, limits in dances:
        own = dance.beats
        if own[-1] < 30:
            continue
        errors = [_late(dance, limits, music) for music in (own / 1.2, _drifting(own))]
        lags = [lag_of_toppra(dance.demand(limits, speed)) for speed in (1.0, 1.2)]
        told = "not installed" if lags[0] is None else ", ".join(f"{1000 * lag:.0f}" for lag in lags if lag is not None)
        print(f"  {f'{dance.name}, {limits.name}':44} {errors[0]:10.1f} {errors[1]:10.1f} {told:>26}")


def _drifting(own: np.ndarray) -> np.ndarray:
    """Music that goes from 0.9 to 1.25 times the dance's tempo and back."""
    gaps = np.diff(own) / (1.075 - 0.175 * np.cos(np.linspace(0, 2 * np.pi, len(own) - 1)))
    return np.concatenate(([0.0], np.cumsum(gaps)))


def _late(dance: Dance, limits: Limits, music: np.ndarray) -> float:
    """ms: where the last beat's pose is wished in the retimed frames, against the music's beat."""
    warp = meet(dance.beats, music).warp
    times = np.arange(int(music[-1] * FPS) + 30) / FPS
    own = warp(times)
    return 1000 * abs(float(np.interp(dance.beats[-1], own, times)) - float(music[-1]))


def timing(dance: Dance, limits: Limits) -> None:
    """CPU seconds of method qp for 30 joints, and how they grow with the length."""
    print("\nqp, 30 joints at 60 Hz, CPU s after warm-up (TALOS' limits on all of them; the solver's own time)")
    columns = [k % dance.angles.shape[1] for k in range(30)]
    lengths = (30, 60, 120, 300, 600)
    spent = list[float]()
    for seconds in lengths:
        demand = _long(dance, limits, columns, seconds)
        fit(_long(dance, limits, columns[:1], 30))
        began = time.process_time()
        fit(demand)
        spent.append(time.process_time() - began)
    print("  " + "  ".join(f"{n} s: {t:.2f}" for n, t in zip(lengths, spent, strict=True)))
    growth = np.polyfit(np.log(lengths), np.log(spent), 1)[0]
    print(f"  grows as length^{growth:.2f}")


def _long(dance: Dance, limits: Limits, columns: Sequence[int], seconds: float) -> Demand:
    angles = dance.angles[:, columns]
    there_and_back = np.concatenate((angles, angles[::-1]))
    count = int(seconds * FPS)
    repeated = np.tile(there_and_back, (count // len(there_and_back) + 1, 1))[: count + 1]
    wish = Spline.through(repeated, FPS)
    low, high, speed, acceleration, jerk = (
        getattr(limits, key)[columns] for key in ("low", "high", "speed", "acceleration", "jerk")
    )
    keyposes = np.arange(1.0, seconds - 1, 1.2)
    return Demand(wish, low, high, speed, acceleration, jerk, keyposes, TimeMap.steady(2.0))


def streaming(name: str, dances: Sequence[tuple[Dance, Limits]]) -> None:
    """A receding horizon under a tempo that steps by up to a fifth at random, every half second to two seconds."""
    print(f"\nReceding horizon, {name}: tempo stepping ±20 % at random, a plan of 2 s every 0.1 s, poses at 1 kHz")
    rng, spent, past, steps, late = np.random.default_rng(0), list[float](), np.zeros(2), 0.0, list[np.ndarray]()
    seconds = 0.0
    for dance, limits in dances:
        source = Table(JointAngles(dance.joints, dance.angles, dance.fps))
        follower = Follower.of(source, limits, dance.keyposes)
        now, own, poses = 0.0, 0.0, list[np.ndarray]()
        change = 0.0
        while own < source.curve.knots.end - 3:
            if now >= change:
                rate = rng.uniform(0.8, 1.2)
                follower.push(np.array([now, now + 1.0]), np.array([own, own + rate]))
                change = now + rng.uniform(0.5, 2.0)
            began = time.process_time()
            poses.append(follower.pull(now + np.arange(100) / 1000))
            spent.append(time.process_time() - began)
            late.append(follower.own(np.array([now]))[0] - follower.expected(np.array([now])))
            now += 0.1
            own = float(follower.expected(np.array([now]))[0])
        all_poses = np.concatenate(poses)
        rates = np.abs(np.diff(all_poses, axis=0)) * 1000
        past += [
            float((np.maximum(limits.low - all_poses, all_poses - limits.high) > 1e-6).any(axis=0).sum()),
            float((rates > limits.speed + 1e-6).any(axis=0).sum()),
        ]
        steps = max(steps, float((rates / limits.speed).max()))
        seconds += now
    ms = 1000 * np.array(spent)
    print(
        f"  {seconds:.0f} s, {past[0]:.0f} joints past their range, {past[1]:.0f} past their speed; fastest step "
        f"{100 * steps:.1f} % of the limit; {np.median(ms):.2f} ms a plan, p99 {np.percentile(ms, 99):.1f}; "
        f"clock {1000 * float(np.median(np.abs(late))):.0f} ms off"
    )


def paper(dances: Sequence[tuple[Dance, Limits]]) -> None:
    """The paper's Fig. 8 as numbers: fine detail kept where no limit is past, and plateaus at the highest speed."""
    print("\nThe paper's experiment (Fig. 8): against Pollard's filter at 1.0 ×, and at 1.2 ×")
    print(
        f"  {'':12} {'detail kept':>12} {'detail far from limits':>23} {'plateaus, s a minute':>21} {'peak acc.':>10}"
    )
    for speed in (1.0, 1.2):
        demands = [dance.demand(limits, speed) for dance, limits in dances]
        print(f"  {speed:g} ×")
        for method in ("layers2007", "layers-qp", "qp", "pollard2002", "clamp"):
            rows = [_figures(demand, METHODS[method](demand, silent).trajectory) for demand in demands]
            all_, far, flat, peak = np.nanmean(np.concatenate(rows), axis=0)
            print(f"  {method:12} {100 * all_:11.1f}% {100 * far:22.1f}% {flat:21.2f} {peak:10.0f}")


def _figures(demand: Demand, trajectory: Spline) -> np.ndarray:
    """(n, 4) of joints past a limit: share of fine velocity kept, the same away from violations, plateaus, peak."""
    past = demand.violated(demand.wish.controls, derivatives=False)
    busy = np.flatnonzero(past.any(axis=0))
    high = butter(4, FINE, "high", fs=1 / demand.wish.knots.step, output="sos")
    knots = demand.wish.knots.times
    was, now = (sosfiltfilt(high, curve(knots, 1)[:, busy], axis=0) for curve in (demand.wish, trajectory))
    margin = round(0.5 / demand.wish.knots.step)
    wide = np.stack([np.convolve(past[1:-1, c], np.ones(2 * margin + 1), "same") > 0 for c in busy], axis=1)
    quiet = ~wide
    kept = 1 - _energy(now - was, np.ones_like(quiet)) / _energy(was, np.ones_like(quiet))
    far = 1 - _energy(now - was, quiet) / np.maximum(_energy(was, quiet), 1e-12)
    found = measure(demand, trajectory)
    return np.column_stack((kept, far, 60 * found.plateaus[busy], found.peak_acceleration[busy]))


def _energy(values: np.ndarray, where: np.ndarray) -> np.ndarray:
    return np.square(values * where).sum(axis=0)
