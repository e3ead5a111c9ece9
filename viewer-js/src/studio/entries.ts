// What somebody has entered in a form is there again after Back, as long as the tab is open; what nobody touched is not kept.

import type { Store } from "./store";

type Control = HTMLInputElement | HTMLSelectElement;

export class Entries {
  private readonly key: string;
  private readonly kept: Record<string, string>;
  private readonly controls = new Map<string, Control>();

  /** `form` names the form and what it is about: two dances have their own. */
  constructor(store: Store, form: string) {
    this.key = `onbeat studio/${store.project?.name ?? ""}/${form}`;
    this.kept = read(this.key);
  }

  /** Keeps what is entered in some controls from now on; `changed` is called after it was. */
  watch(controls: Record<string, Control>, changed: () => void = () => undefined): void {
    for (const [name, control] of Object.entries(controls)) {
      this.controls.set(name, control);
      const event = control instanceof HTMLSelectElement || control.type === "checkbox" ? "change" : "input";
      control.addEventListener(event, () => {
        this.note(name);
        changed();
      });
    }
  }

  /** What was entered before is in the controls again, those of some names or all. */
  restore(...names: readonly string[]): void {
    for (const [name, control] of this.controls) {
      const value = this.kept[name];
      if (value === undefined || (names.length && !names.includes(name))) continue;
      if (control instanceof HTMLSelectElement) {
        if (Array.from(control.options).some((one) => one.value === value)) control.value = value;
      } else if (control.type === "checkbox") control.checked = value === "true";
      else control.value = value;
    }
  }

  /** A control was given a value in another way than by its own. */
  note(...names: readonly string[]): void {
    for (const name of names) {
      const control = this.controls.get(name);
      if (!control) continue;
      this.set(name, control instanceof HTMLInputElement && control.type === "checkbox" ? String(control.checked) : control.value);
    }
  }

  get(name: string): string | undefined {
    return this.kept[name];
  }

  set(name: string, value: string): void {
    this.kept[name] = value;
    write(this.key, this.kept);
  }

  forget(name: string): void {
    delete this.kept[name];
    write(this.key, this.kept);
  }
}

function read(key: string): Record<string, string> {
  try {
    return JSON.parse(sessionStorage.getItem(key) ?? "{}") as Record<string, string>;
  } catch {
    return {}; // the browser keeps nothing
  }
}

function write(key: string, kept: Record<string, string>): void {
  try {
    sessionStorage.setItem(key, JSON.stringify(kept));
  } catch {
    // the browser keeps nothing
  }
}
