// The runs of this page; index.html contains their data.
//
// A *frame* is a state of the simulation, at frame / fps. A *picture* is what the video or the stills show of it: the
// k-th picture shows frame frames[k] or, if no picture is missing, first + k * step. All parts of the page use the time of the frame.
"use strict";
{
  const { known, plural } = review.format;
  const EXIT_CODES = { 1: "own fault", 2: "command line", 3: "scene", 4: "asset", 5: "simulation", 6: "output", 75: "interrupted" };
  const ASSUMED_FPS = 25; // for a video whose rate is unknown [pictures per second]

  class Run {
    constructor(data) {
      this.id = data.id;
      this.name = data.name;
      this.problems = data.problems;
      this.stats = data.stats;
      this.totals = data.stats.totals ?? {};
      this.digest = data.digest; // summary of the columns, for the figures
      this.columns = {}; // empty until load(), like `effective`
      this.effective = null;
      this.pictures = data.pictures;
      this.sheet = data.sheet ?? [];
      this.poster = data.poster ?? null;
      this.referenceId = data.reference ?? null;
      this.comparison = data.comparison ?? []; // the pictures of the contact sheet, compared with the reference
      this.isReference = data.id.startsWith("references/");
      this.date = data.date ? new Date(data.date) : null;
      this.of = data.of ?? ""; // fingerprint of its pictures
      this.home = data.home;
      this.key = data.key;
      this.filed = data.decision ?? null; // entry of review.json
      this.accept = data.accept ?? null;
      this.values = data.values ?? {}; // for a sweep: changed values, by key
    }

    /** Loads the data for the run's own page, once. They are a script, since a page opened from a file may load nothing else. */
    load() {
      this.loading ??= new Promise((resolve) => {
        const script = document.createElement("script");
        script.onload = resolve;
        script.onerror = () => {
          this.problems.push(`${this.id}/data.js cannot be read: no plots, no scene`);
          resolve();
        };
        script.src = `${this.id}/data.js`;
        document.head.append(script);
      });
      return this.loading;
    }
    loaded({ columns, effective }) {
      this.columns = columns;
      this.effective = effective;
      this.rows = new Map((this.column("frame") ?? []).map((frame, row) => [frame, row]));
    }

    get scene() {
      return this.stats.scene ?? this.name;
    }
    /** The name. For a run of a sweep, without its last part: the scene's name, which all runs of the sweep share. */
    get title() {
      return Object.keys(this.values).length > 0 ? this.name.replace(/\/[^/]*$/, "") : this.name;
    }
    get label() {
      return this.isReference ? `${this.name} (reference)` : this.name;
    }
    get reference() {
      return review.model.find(this.referenceId);
    }
    get aspect() {
      const { width, height } = this.pictures;
      return known(width) && known(height) ? width / height : 16 / 9;
    }

    // Pictures per second.
    get fps() {
      return this.pictures.fps > 0 ? this.pictures.fps : ASSUMED_FPS;
    }
    get hasPictures() {
      return this.pictures.kind !== "none" && (this.pictures.count > 0 || this.pictures.kind === "video");
    }
    frameOf(picture) {
      return this.pictures.frames?.[picture] ?? this.pictures.first + picture * this.pictures.step;
    }
    timeOf(picture) {
      return this.frameOf(picture) / (this.fps * this.pictures.step);
    }
    pictureAt(time) {
      const { frames, first, step } = this.pictures;
      const frame = time * this.fps * step;
      if (frames) return frames.reduce((best, each, at) => (Math.abs(each - frame) < Math.abs(frames[best] - frame) ? at : best), 0);
      const picture = Math.round((frame - first) / step);
      return Math.max(0, Math.min(this.pictures.count - 1, picture));
    }
    pictureOfFrame(frame) {
      return this.pictureAt(frame / (this.fps * this.pictures.step));
    }

    /** One value per simulated frame, or undefined if the statistics do not have the column. */
    column(name) {
      const column = this.columns[name];
      return column?.some(known) ? column : undefined;
    }
    valueAt(name, frame) {
      return this.columns[name]?.[this.rows?.get(frame)];
    }

    /** Verdict over all compared pictures: {level, text, note}, or null if none was compared. */
    get likeness() {
      if (this.comparison.length === 0) return null;
      const differing = this.comparison.filter(({ verdict }) => verdict === "differs").length;
      if (differing > 0) return { level: "bad", text: "differs", note: "from the reference, past the limits of weft diff" };
      const same = this.comparison.every(({ verdict }) => verdict === "same");
      return { level: "good", text: same ? "same" : "like reference", note: "compared with the reference" };
    }
    comparedNear(picture) {
      const distance = (pair) => Math.abs(pair.picture - picture);
      return this.comparison.reduce((nearest, pair) => (distance(pair) < distance(nearest) ? pair : nearest));
    }

    get warnings() {
      return this.stats.warnings ?? [];
    }
    /** The message that says why the run ended early, if it did, and the warnings. */
    get reasons() {
      return this.stats.message ? [this.stats.message, ...this.warnings] : this.warnings;
    }
    /** {level, text}: level is good, warn, bad or unknown. */
    get verdict() {
      const code = this.stats.exit_code;
      if (code === undefined) return { level: "unknown", text: "no statistics" };
      if (code === 75) return { level: "warn", text: "interrupted" };
      if (code !== 0) return { level: "bad", text: `failed: ${EXIT_CODES[code] ?? `exit code ${code}`}` };
      if (this.warnings.length > 0) return { level: "warn", text: plural(this.warnings.length, "warning") };
      return { level: "good", text: "well" };
    }
  }

  const data = JSON.parse(document.getElementById("review-data").textContent);
  const runs = data.runs.map((run) => new Run(run));
  const references = data.references.map((run) => new Run(run));
  const byId = new Map([...runs, ...references].map((run) => [run.id, run]));

  runs.forEach((run, place) => (run.place = place));

  // Keys with several values among the runs of a sweep. Numbers are sorted by value, texts stay in the order of the sweep.
  const keys = [...new Set(runs.flatMap(({ values }) => Object.keys(values)))];
  const swept = keys.filter((key) => new Set(runs.map(({ values }) => values[key])).size > 1).map((key) => {
    const texts = [...new Set(runs.map(({ values }) => values[key]))];
    const last = key.split(".").at(-1);
    const alone = keys.filter((other) => other.split(".").at(-1) === last).length === 1;
    const value = ({ values }) => (known(Number(values[key])) ? Number(values[key]) : values[key] && texts.indexOf(values[key]));
    return { key, label: alone ? last : key, text: ({ values }) => values[key] ?? "", value };
  });

  const age = (run) => run.date?.getTime() ?? 0;
  // Runs with the same text are versions of each other: they have the same scene and, in a sweep, the same values.
  const shot = (run) => JSON.stringify([run.scene, run.values]);
  /** Runs of the same scene, the newest first. */
  const versions = (run) => runs.filter((other) => shot(other) === shot(run)).sort((a, b) => age(b) - age(a));
  const newest = new Map();
  for (const run of runs) if (!newest.has(shot(run)) || age(run) > age(newest.get(shot(run)))) newest.set(shot(run), run);

  review.loaded = (id, detail) => byId.get(id)?.loaded(detail);
  review.model = {
    version: data.version, runs, references, versions, swept,
    find: (id) => byId.get(id) ?? null,
    isNewest: (run) => newest.get(shot(run)) === run,
  };
}
