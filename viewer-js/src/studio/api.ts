// Asking the server at this page's own address. What it refuses comes back as words.

/** A refusal, in the server's words; `field` is the entry of a form that it is about. */
export class Refusal extends Error {
  constructor(
    words: string,
    readonly status: number,
    readonly field?: string,
  ) {
    super(words);
  }
}

export const AWAY = "The studio's server does not answer. Is `onbeat studio` still running?";

export async function ask<T>(method: string, path: string, body?: unknown): Promise<T> {
  const sent =
    body === undefined ? {} : { body: JSON.stringify(body), headers: { "Content-Type": "application/json" } };
  let answer: Response;
  try {
    answer = await fetch(`/api/${path}`, { method, ...sent });
  } catch {
    throw new Refusal(AWAY, 0);
  }
  return read<T>(answer.status, await answer.text());
}

/** Sends a file as it is; `told` hears how much of it has gone, 0…1. */
export function send<T>(path: string, file: File, told: (share: number) => void): Promise<T> {
  return new Promise((done, fail) => {
    const request = new XMLHttpRequest(); // `fetch` does not tell how far it is
    request.open("POST", `/api/${path}?name=${encodeURIComponent(file.name)}`);
    request.setRequestHeader("Content-Type", "application/octet-stream");
    request.upload.onprogress = ({ loaded, total }) => told(total ? loaded / total : 0);
    request.onerror = () =>
      fail(new Refusal(`${file.name} could not be sent: it was refused on the way, or the server is gone.`, 0));
    request.onload = () => {
      try {
        done(read<T>(request.status, request.responseText));
      } catch (error) {
        fail(error);
      }
    };
    request.send(file);
  });
}

function read<T>(status: number, text: string): T {
  let document: unknown;
  try {
    document = text ? JSON.parse(text) : undefined;
  } catch {
    throw new Refusal(`The server answered with something that is no document (${status}).`, status);
  }
  if (status >= 200 && status < 300) return document as T;
  const { error, field } = (document ?? {}) as { error?: string; field?: string };
  throw new Refusal(error ?? `The server refused, without a word (${status}).`, status, field);
}

export function words(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
