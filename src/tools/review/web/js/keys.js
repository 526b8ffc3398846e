// Keyboard: pages bind keys to actions; the key `?` lists them.
"use strict";
{
  const { h } = review;
  let bindings = [];

  // Whether the focused element itself uses the key: text fields, lists, sliders, buttons.
  const takesKey = (target, key) => {
    if (target.matches("textarea, select, input[type=search], input[type=text], input[type=number]")) return key !== "Escape";
    if (target.matches("input[type=range]")) return /^(Arrow|Page|Home|End)/.test(key) && !target.matches(".scrubber");
    return target.matches("button, a, summary, input[type=checkbox]") && (key === " " || key === "Enter");
  };

  const nameOf = (event) => (event.shiftKey && event.key.length > 1 ? `Shift+${event.key}` : event.key);

  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector("dialog[open]")) return;
    if (takesKey(event.target, event.key)) return;
    const binding = bindings.find(({ keys }) => keys.includes(nameOf(event)));
    if (!binding) return;
    event.preventDefault();
    binding.action(event);
  });

  const SHOWN = { " ": "Space", ArrowLeft: "←", ArrowRight: "→", ArrowUp: "↑", ArrowDown: "↓",
                  "Shift+ArrowLeft": "Shift ←", "Shift+ArrowRight": "Shift →" };

  review.keys = {
    /** Replaces all bindings: {keys, does, action} each, in the order in which `?` lists them. */
    bind(list) {
      bindings = list.filter(Boolean);
    },
    showHelp() {
      const dialog = document.getElementById("help");
      const rows = bindings.map(({ keys, does }) =>
        h("tr", {}, h("th", { scope: "row" }, keys.map((key) => [h("kbd", {}, SHOWN[key] ?? key), " "])), h("td", {}, does)));
      dialog.replaceChildren(
        h("h2", { id: "help-title" }, "Keys on this page"),
        h("table.keys", {}, h("tbody", {}, rows)),
        h("form", { method: "dialog" }, h("button", {}, "Close")));
      dialog.showModal();
    },
  };
}
