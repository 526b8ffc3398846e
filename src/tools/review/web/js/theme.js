// Dark or light colours: as the system, unless the reader has chosen. Runs before the browser draws the page.
"use strict";

const review = {}; // the only global name of the scripts of this page

{
  const KEY = "weft-review-theme";
  const CHOICES = ["auto", "light", "dark"];
  const changed = new EventTarget();

  // A browser may refuse storage to a page that is opened from a file. The choice is then lost when the page is closed.
  const stored = () => {
    try {
      return localStorage.getItem(KEY);
    } catch {
      return null;
    }
  };
  const store = (choice) => {
    try {
      localStorage.setItem(KEY, choice);
    } catch {
      // the browser refuses storage
    }
  };

  let choice = CHOICES.includes(stored()) ? stored() : "auto";
  const system = matchMedia("(prefers-color-scheme: dark)");

  const apply = () => {
    const dark = choice === "dark" || (choice === "auto" && system.matches);
    document.documentElement.dataset.theme = dark ? "dark" : "light";
    changed.dispatchEvent(new Event("change"));
  };
  system.addEventListener("change", apply);
  apply();

  review.theme = {
    get choice() {
      return choice;
    },
    next() {
      choice = CHOICES[(CHOICES.indexOf(choice) + 1) % CHOICES.length];
      store(choice);
      apply();
    },
    onChange(listener, signal) {
      changed.addEventListener("change", listener, { signal });
    },
    color(name) {
      return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
    },
  };
}
