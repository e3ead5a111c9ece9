// The last seconds of poses, and where the body is between them.

import type { Places } from "../path";
import type { PoseAt } from "./messages";

const KEPT = 3; // [s]
const MOST = 600;
const NEAR = 0.06; // [s] over a longer gap the way is straight

export class Poses implements Places {
  count = 0; // that came
  private poses: PoseAt[] = [];

  /** Time of the newest; −∞ before there is one. */
  get newest(): number {
    return this.poses.length ? this.poses[this.poses.length - 1].time : -Infinity;
  }

  clear(): void {
    this.poses = [];
  }

  add(pose: PoseAt): void {
    this.count++;
    if (pose.time < this.newest - KEPT) this.clear(); // another session
    if (pose.time <= this.newest) return;
    this.poses.push(pose);
    const old = this.poses.findIndex(({ time }) => time >= pose.time - KEPT);
    if (old > 60 || this.poses.length > MOST) this.poses.splice(0, Math.max(old, 1));
  }

  /** A cubic through the poses about a time; before the first and after the last the body holds still. */
  read(time: number, into: Float32Array): void {
    const poses = this.poses;
    if (!poses.length) return;
    let after = poses.length;
    while (after > 0 && poses[after - 1].time > time) after--; // the time is near the end
    const [a, b] = [poses[Math.max(after - 1, 0)], poses[Math.min(after, poses.length - 1)]];
    const span = b.time - a.time;
    if (span <= 0) return into.set(a.points);
    const t = (time - a.time) / span;
    const before = poses[after - 2];
    const next = poses[after + 1];
    // Tangents by finite differences; one-sided where a neighbour is missing or far.
    const p = before && a.time - before.time < NEAR && span < NEAR ? before : undefined;
    const q = next && next.time - b.time < NEAR && span < NEAR ? next : undefined;
    const [rise, fall] = [p ? span / (b.time - p.time) : 0, q ? span / (q.time - a.time) : 0];
    const [h10, h01, h11] = [t * (1 - t) * (1 - t), t * t * (3 - 2 * t), t * t * (t - 1)];
    for (let i = 0; i < into.length; i++) {
      const [from, to] = [a.points[i], b.points[i]];
      const straight = to - from;
      const leave = p ? (to - p.points[i]) * rise : straight;
      const arrive = q ? (q.points[i] - from) * fall : straight;
      into[i] = from + h01 * straight + h10 * leave + h11 * arrive;
    }
  }
}
