// The song's sound at another speed in its own pitch: a media element plays it, as browsers know how to.

const [HEADER, WIDE] = [44, 2]; // [bytes] of a WAV file before its samples, and of one of them

export class Stretched {
  private readonly element = new Audio();

  /**
   * The element gets the samples as they are decoded, from second `silent` on: in an MP3 it would not seek exactly.
   * `failed` is called where this browser cannot play them.
   */
  constructor(
    buffer: AudioBuffer,
    silent: number,
    private readonly failed: () => void,
  ) {
    this.element.preload = "auto";
    this.element.addEventListener("error", failed);
    this.element.preservesPitch = true;
    Object.assign(this.element, { mozPreservesPitch: true, webkitPreservesPitch: true }); // browsers of before 2023
    this.element.src = URL.createObjectURL(new Blob([wave(buffer, silent)], { type: "audio/wav" }));
  }

  /** Second of the song that is heard now; undefined where nothing is. */
  get heard(): number | undefined {
    const { paused, ended, readyState, currentTime } = this.element;
    return paused || ended || readyState < HTMLMediaElement.HAVE_CURRENT_DATA ? undefined : currentTime;
  }

  get over(): boolean {
    return this.element.ended;
  }

  start(at: number, rate: number): void {
    this.element.currentTime = at;
    this.element.playbackRate = rate;
    this.element.play().catch((error: DOMException) => {
      if (error.name !== "AbortError") this.failed(); // aborted: paused again before it began
    });
  }

  stop(): void {
    this.element.pause();
  }
}

/** Samples as a WAV file of 16 bits. */
function wave(buffer: AudioBuffer, silent: number): ArrayBuffer {
  const channels = Array.from({ length: buffer.numberOfChannels }, (_, i) => buffer.getChannelData(i));
  const first = Math.round(silent * buffer.sampleRate);
  const frames = Math.max(buffer.length - first, 0);
  const size = frames * channels.length * WIDE;
  const view = new DataView(new ArrayBuffer(HEADER + size));
  const words = (at: number, text: string): void => [...text].forEach((letter, i) => view.setUint8(at + i, letter.charCodeAt(0)));
  words(0, "RIFF");
  view.setUint32(4, HEADER - 8 + size, true);
  words(8, "WAVEfmt ");
  view.setUint32(16, 16, true);
  view.setUint16(20, 1, true);
  view.setUint16(22, channels.length, true);
  view.setUint32(24, buffer.sampleRate, true);
  view.setUint32(28, buffer.sampleRate * channels.length * WIDE, true);
  view.setUint16(32, channels.length * WIDE, true);
  view.setUint16(34, 8 * WIDE, true);
  words(36, "data");
  view.setUint32(40, size, true);
  const samples = new Int16Array(view.buffer, HEADER);
  channels.forEach((channel, k) => {
    for (let i = 0; i < frames; i++) {
      samples[i * channels.length + k] = 32767 * Math.min(Math.max(channel[first + i], -1), 1);
    }
  });
  return view.buffer;
}
