// The line to the session: opened again and again when it is lost, and given up when it has gone quiet.

import type { Command, Told } from "./contract";
import { readTold } from "./messages";

const WAITS = [0.3, 0.6, 1.2, 2.5, 4]; // [s] before the next attempt
const QUIET = 3; // [s] a session says something twenty times a second
const LONGEST = 1 << 20; // characters of what is told

export interface Listener {
  told(told: Told): void;
  pose(bytes: ArrayBuffer): void;
  refused(): void; // something came that could not be read
  lost(): void; // it is tried again
}

export class Connection {
  private socket?: WebSocket;
  private attempts = 0;
  private heardAt = 0; // [ms]
  private retry?: ReturnType<typeof setTimeout>;

  constructor(
    private readonly address: string,
    private readonly listener: Listener,
  ) {
    setInterval(() => this.watch(), 1000);
    addEventListener("online", () => this.hurry());
    document.addEventListener("visibilitychange", () => this.hurry());
    this.open();
  }

  /** Sends a command; false where nobody is there to take it. */
  send(what: Command["do"], value = ""): boolean {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify({ type: "command", do: what, value } satisfies Command));
    return true;
  }

  private open(): void {
    clearTimeout(this.retry);
    this.retry = undefined;
    const socket = new WebSocket(this.address);
    this.socket = socket;
    socket.binaryType = "arraybuffer";
    this.heardAt = performance.now();
    socket.onmessage = ({ data }) => this.take(data);
    socket.onclose = () => this.lose(socket);
  }

  private take(data: string | ArrayBuffer): void {
    this.heardAt = performance.now();
    if (typeof data !== "string") return this.listener.pose(data);
    const told = data.length <= LONGEST ? readTold(data) : undefined;
    if (!told) return this.listener.refused();
    if (told.type === "hello") this.attempts = 0;
    this.listener.told(told);
  }

  private lose(socket: WebSocket): void {
    if (socket !== this.socket) return;
    this.socket = undefined;
    const wait = WAITS[Math.min(this.attempts++, WAITS.length - 1)];
    this.retry = setTimeout(() => this.open(), wait * 1000);
    this.listener.lost();
  }

  /** A line that is open but says nothing is a dead one. */
  private watch(): void {
    const socket = this.socket;
    if (!socket || performance.now() - this.heardAt < QUIET * 1000) return;
    socket.onmessage = socket.onclose = null;
    socket.close();
    this.lose(socket);
  }

  /** Who comes back to the page does not wait for the next attempt. */
  private hurry(): void {
    if (this.retry !== undefined && !document.hidden) this.open();
  }
}
