// Where the joints of a stored motion are at any time between its frames.

import type { PageData } from "./contract";
import { readPath } from "./data";

/** Says where the points of a body are at a time: `into` is points x 3 [m]. */
export interface Places {
  read(time: number, into: Float32Array): void;
}

export class StoredPath implements Places {
  private readonly path: Float32Array;

  constructor(private readonly page: Pick<PageData, "path" | "frames" | "fps">) {
    this.path = readPath(page.path);
  }

  /** Catmull-Rom between frames, so that slow motion is smooth too. */
  read(time: number, into: Float32Array): void {
    const size = into.length;
    const last = this.page.frames - 1;
    const at = Math.min(Math.max(time * this.page.fps, 0), last);
    const frame = Math.min(Math.floor(at), Math.max(last - 1, 0));
    const t = at - frame;
    const [p, q, r, s] = [frame - 1, frame, frame + 1, frame + 2].map((f) => Math.min(Math.max(f, 0), last) * size);
    const [wp, wq, wr, ws] = [
      ((2 - t) * t - 1) * t * 0.5,
      ((3 * t - 5) * t * t + 2) * 0.5,
      ((4 - 3 * t) * t + 1) * t * 0.5,
      (t - 1) * t * t * 0.5,
    ];
    for (let i = 0; i < size; i++) {
      into[i] = wp * this.path[p + i] + wq * this.path[q + i] + wr * this.path[r + i] + ws * this.path[s + i];
    }
  }
}
