// A light or a dark room: as the machine has it, until somebody presses the button.

const KEY = "onbeat live theme";

export class Theme {
  dark = false;

  constructor(private readonly changed: () => void) {
    const wished = matchMedia("(prefers-color-scheme: dark)");
    this.put(kept() ?? wished.matches);
    wished.addEventListener("change", () => kept() === undefined && this.put(wished.matches));
  }

  toggle(): void {
    this.put(!this.dark);
    try {
      localStorage.setItem(KEY, this.dark ? "dark" : "light");
    } catch {
      // a browser that keeps nothing asks its machine again next time
    }
  }

  private put(dark: boolean): void {
    this.dark = dark;
    document.documentElement.dataset.theme = dark ? "dark" : "light";
    this.changed();
  }
}

function kept(): boolean | undefined {
  try {
    const theme = localStorage.getItem(KEY);
    return theme === null ? undefined : theme === "dark";
  } catch {
    return undefined;
  }
}
