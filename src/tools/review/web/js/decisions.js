// Decisions about runs: those that review.json had when weft review wrote the page, and later changes made on the page.
// The browser stores these changes until the reader puts the downloaded file into its folder and weft review writes the
// page again.
"use strict";
{
  const FORMAT = "weft review 1";
  const STATES = ["open", "needs work", "approved"];
  const place = `weft-review-decisions:${location.pathname}`;
  const changed = new EventTarget();

  // A browser may refuse storage to a page that is opened from a file. Decisions are then lost when the page is closed.
  const stored = (key, otherwise) => {
    try {
      return JSON.parse(localStorage.getItem(key)) ?? otherwise;
    } catch {
      return otherwise;
    }
  };
  const store = (key, value) => {
    try {
      localStorage.setItem(key, JSON.stringify(value));
    } catch {
      // the browser refuses storage
    }
  };

  let own = stored(place, {}); // changes, by the searched folder (home) and the key of the run
  let author = stored("weft-review-author", "");

  const ownOf = (run) => own[run.home]?.[run.key];
  // Whether there is a change on the page that is later than the entry of review.json. Dates are ISO 8601 in UTC, so
  // they compare as text.
  const isPending = (run) => ownOf(run) !== undefined && (ownOf(run).date ?? "") > (run.filed?.date ?? "");
  const entryOf = (run) => (isPending(run) ? ownOf(run) : run.filed) ?? { state: "open", notes: [] };

  // Takes over the changes that other tabs with this page have stored. Of two changes of a run, the later one counts.
  const takeStored = () => {
    for (const [home, runs] of Object.entries(stored(place, {})))
      for (const [key, entry] of Object.entries(runs)) {
        const known = own[home]?.[key];
        if (!known || entry.date > known.date) own = { ...own, [home]: { ...own[home], [key]: entry } };
      }
  };
  // Changes the entry of a run. `partOf(entry)` returns the members that change.
  const change = (run, partOf) => {
    takeStored();
    const entry = entryOf(run);
    own = { ...own, [run.home]: { ...own[run.home], [run.key]: { ...entry, of: run.of, by: author, date: new Date().toISOString(), ...partOf(entry) } } };
    store(place, own);
    changed.dispatchEvent(new Event("change"));
  };

  addEventListener("storage", ({ key }) => {
    if (key !== place) return;
    takeStored();
    changed.dispatchEvent(new Event("change"));
  });

  review.decisions = {
    STATES,
    get author() {
      return author;
    },
    set author(name) {
      author = name;
      store("weft-review-author", name);
    },
    notes: (run) => entryOf(run).notes ?? [],
    entry: entryOf,
    /** One of STATES, or "changed" if the pictures have changed since the decision. */
    state(run) {
      const { state, of } = entryOf(run);
      return state !== "open" && of !== run.of ? "changed" : state;
    },
    /** {level, text, note} for a label that shows the decision; null if there is none. */
    chip(run) {
      const { state, by, date } = entryOf(run);
      const note = [by && `by ${by}`, date && review.format.date(new Date(date))].filter(Boolean).join(", ");
      const shown = review.decisions.state(run);
      if (shown === "open") return null;
      if (shown === "changed") return { level: "warn", text: `changed since ${state}`, note };
      return { level: shown === "approved" ? "good" : "bad", text: shown, note };
    },
    decide: (run, state) => change(run, () => ({ state })),
    /** `marks`: polylines; points are fractions of the picture's width and height. */
    add: (run, frame, text, marks) => change(run, ({ of, notes = [] }) => ({ of: of ?? run.of, notes: [...notes,
      { frame, text, by: author, date: new Date().toISOString(), of: run.of, marks }] })),
    remove: (run, note) => change(run, ({ of, notes = [] }) => {
      const at = notes.findIndex((other) => JSON.stringify(other) === JSON.stringify(note));
      return { of: of ?? run.of, notes: notes.filter((_, i) => i !== at) };
    }),

    /** Folders whose review.json lacks changes, each with the number of changed runs. */
    get pending() {
      const homes = new Map();
      for (const run of review.model.runs) if (isPending(run)) homes.set(run.home, (homes.get(run.home) ?? 0) + 1);
      return homes;
    },
    /** The text of review.json for a folder: all decisions about its runs. */
    file(home) {
      const runs = review.model.runs.filter((run) => run.home === home && (isPending(run) || run.filed));
      return `${JSON.stringify({ format: FORMAT, runs: Object.fromEntries(runs.map((run) => [run.key, entryOf(run)])) }, null, 1)}\n`;
    },
    download(home) {
      const link = review.h("a", { download: "review.json", href: `data:application/json;charset=utf-8,${encodeURIComponent(review.decisions.file(home))}` });
      link.click();
    },
    onChange: (listener, signal) => changed.addEventListener("change", listener, { signal }),
  };

  const quoted = (text) => (/^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);
  /** The command that makes the run's pictures the reference; its reason is the last note of an approval. null: no pictures. */
  review.acceptLine = (run) => {
    const { file, prefix, reference } = run.accept ?? {};
    if (!file && !prefix) return null;
    const reason = review.decisions.state(run) === "approved" ? (review.decisions.notes(run).at(-1)?.text.split("\n")[0] ?? "") : "";
    return `weft accept ${quoted(reference)} ${file ? quoted(file) : `${quoted(prefix)}[0-9]*.png`} --reason ${quoted(reason || "WHY")}`;
  };

  /** One button for each folder whose review.json lacks changes; it downloads the new file. */
  review.downloads = () => {
    const element = review.h("span.downloads", { role: "status" });
    const show = () => element.replaceChildren(...[...review.decisions.pending].map(([home, count]) =>
      review.h("button", { type: "button", title: `To be put into ${home}; weft review reads it there`, onclick: () => review.decisions.download(home) },
        `Download review.json for ${home}: ${review.format.plural(count, "new decision")}`)));
    show();
    return { element, show };
  };
}
