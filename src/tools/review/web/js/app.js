// Opens the page that the fragment of the URL names. Makes the bar at the top and the keys that work on all pages.
//
// Fragments: #run=ID (&with=ID&view=slider&frame=12), #compare=ID&compare=ID (&left=ID&right=ID&view=side&frame=12),
// else the overview (#chosen=ID&sort=strain).
"use strict";
{
  const { h } = review;
  const content = document.getElementById("content");
  const themeSwitch = document.getElementById("theme-switch");
  let page = null;
  let written = null; // the fragment that replaceAddress() wrote last

  // Writes the state of the page to the fragment of the URL without opening the page again.
  review.replaceAddress = (address) => {
    written = `#${address}`;
    if (location.hash.replace(/^#?$/, "#") === written) return;
    history.replaceState(null, "", written);
  };

  const makePage = (address) => {
    if (review.model.find(address.get("run"))) return new review.RunPage(address);
    if (address.getAll("compare").filter(review.model.find).length >= 2) return new review.ComparePage(address);
    return new review.OverviewPage(address);
  };

  // The runs whose details the page needs.
  const shown = (address) => {
    const run = review.model.find(address.get("run"));
    const ids = run ? [run.id, address.get("with") ?? run.referenceId] : address.getAll("compare");
    return ids.map(review.model.find).filter(Boolean);
  };

  const open = async () => {
    const asked = location.hash;
    const address = new URLSearchParams(asked.slice(1));
    await Promise.all(shown(address).map((run) => run.load()));
    if (location.hash !== asked) return; // the address has changed meanwhile, and its own event opens the page
    page?.close();
    const firstTime = page === null;
    page = makePage(address);
    content.replaceChildren(page.element);
    document.title = `${page.title} – Weft review`;
    document.getElementById("trail").replaceChildren(
      ...(page instanceof review.OverviewPage ? [] : [h("a", { href: "#" }, "Overview"), h("span", { "aria-current": "page" }, page.title)]));
    review.keys.bind([...page.keys, ...everywhere(page)]);
    page.mounted();
    scrollTo(0, 0);
    if (!firstTime) content.focus({ preventScroll: true });
  };

  const everywhere = (current) => [
    !(current instanceof review.OverviewPage) && { keys: ["o", "Escape"], does: "overview", action: () => (location.hash = "") },
    { keys: ["t"], does: "colours: as the system, light, dark", action: () => review.theme.next() },
    { keys: ["?"], does: "these keys", action: () => review.keys.showHelp() },
  ];

  const showTheme = () => {
    const { choice } = review.theme;
    const name = { auto: "Auto", light: "Light", dark: "Dark" }[choice];
    themeSwitch.textContent = name;
    themeSwitch.title = `Colours: ${choice === "auto" ? "as the system" : choice} (t)`;
    themeSwitch.ariaLabel = `${name}: colours ${choice === "auto" ? "as the system" : "of the page"}`;
  };

  themeSwitch.addEventListener("click", () => review.theme.next());
  document.getElementById("help-switch").addEventListener("click", () => review.keys.showHelp());
  review.theme.onChange(() => {
    showTheme();
    page?.themeChanged?.();
  });
  addEventListener("hashchange", () => {
    if (location.hash !== written) open();
  });
  showTheme();
  open();
}
