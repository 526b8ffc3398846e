// On the page of a run: its decision, notes with marks on the picture, and the command that accepts its pictures.
"use strict";
{
  const { h, svg } = review;
  const { date, plural } = review.format;
  const WORDS = { open: "Open", "needs work": "Needs work", approved: "Approved" };
  const LEAST_MOVE = 0.004; // smallest distance of two consecutive points of a mark, as a fraction of the picture

  /** The marks on the picture of a viewer: those of the notes at its frame, and new ones that have no note yet. */
  review.Marks = class {
    constructor(viewer) {
      this.viewer = viewer;
      this.width = 1000 * viewer.runs[0].aspect;
      this.lines = []; // lines that the reader has drawn, but not yet saved with a note
      this.element = svg("svg", { class: "drawn", viewBox: `0 0 ${this.width} 1000`, "aria-hidden": "true" });
      viewer.blend.append(this.element);
      this.element.addEventListener("pointerdown", (event) => this.begin(event));
      this.element.addEventListener("pointermove", (event) => this.go(event));
    }
    set drawing(on) {
      this.viewer.stage.toggleAttribute("data-drawing", on);
    }
    at({ clientX, clientY }) {
      const point = new DOMPoint(clientX, clientY).matrixTransform(this.element.getScreenCTM().inverse());
      const share = (value) => Math.round(1e4 * Math.max(0, Math.min(1, value))) / 1e4;
      return [share(point.x / this.width), share(point.y / 1000)];
    }
    begin(event) {
      event.stopPropagation(); // else the slider moves too
      this.element.setPointerCapture(event.pointerId);
      this.lines.push([this.at(event)]);
      this.draw();
    }
    go(event) {
      if (event.buttons === 0 || this.lines.length === 0) return;
      event.stopPropagation();
      const line = this.lines.at(-1), [x, y] = this.at(event), [lastX, lastY] = line.at(-1);
      if (Math.hypot(x - lastX, y - lastY) < LEAST_MOVE) return;
      line.push([x, y]);
      this.draw();
    }
    show(lines) {
      this.noted = lines;
      this.draw();
    }
    clear() {
      this.lines = [];
      this.draw();
    }
    draw() {
      const path = (line) => `M${(line.length > 1 ? line : [line[0], line[0]]).map(([x, y]) => `${x * this.width} ${1000 * y}`).join("L")}`;
      this.element.replaceChildren(...[...(this.noted ?? []), ...this.lines].filter((line) => line.length > 0)
        .flatMap((line) => ["under", "over"].map((name) => svg("path", { class: name, d: path(line) }))));
    }
  };

  review.DecisionPanel = class {
    /** If `viewer` is null, a click on a note does not show its frame. */
    constructor(run, viewer) {
      this.run = run;
      this.viewer = viewer;
      this.marks = viewer && new review.Marks(viewer);
      this.listening = new AbortController();
      this.states = review.decisions.STATES.map((state) =>
        h("button", { type: "button", "data-state": state, onclick: () => review.decisions.decide(run, state) }, WORDS[state]));
      this.who = h("span.muted");
      this.author = h("input", { type: "text", "aria-label": "Your name", placeholder: "Your name", value: review.decisions.author,
        onchange: () => (review.decisions.author = this.author.value.trim()) });
      this.text = h("textarea", { rows: 2, "aria-label": "New note", placeholder: "What is seen at this frame",
        onkeydown: (event) => this.typed(event) });
      this.drawButton = h("button", { type: "button", "aria-pressed": "false", onclick: () => this.toggleDrawing() }, "Draw on the picture");
      this.addButton = h("button.primary", { type: "button", onclick: () => this.add() });
      this.list = h("ol.note-list");
      this.line = h("code.accept-line", { tabindex: 0, role: "group", "aria-label": "Command that makes this run the reference" });
      this.copied = h("span.muted", { role: "status" });
      this.downloads = review.downloads();
      this.element = review.section("Decision",
        h("div.decide", {}, h("div.segments", { role: "group", "aria-label": "State of the run" }, this.states), this.author, this.who),
        this.list,
        h("div.new-note", {}, this.text, h("div.note-tools", {}, this.marks && this.drawButton, this.addButton)),
        review.acceptLine(run) && h("div.accept", {}, this.line, h("button", { type: "button", onclick: () => this.copy() }, "Copy"), this.copied),
        this.downloads.element);
      this.element.classList.add("decision");
      review.decisions.onChange(() => this.show(), this.listening.signal);
      this.show();
      this.showFrame();
    }

    get frame() {
      return this.viewer ? this.viewer.player.frame : 0;
    }
    show() {
      const { state, by, date: when } = review.decisions.entry(this.run);
      const now = review.decisions.state(this.run);
      for (const button of this.states) button.setAttribute("aria-pressed", button.dataset.state === now);
      this.who.textContent = [now === "changed" && `${state} for other pictures than these`, by && `by ${by}`, when && date(new Date(when))].filter(Boolean).join(", ");
      this.list.replaceChildren(...review.decisions.notes(this.run).map((note) => this.noteItem(note)));
      this.line.textContent = review.acceptLine(this.run) ?? "";
      this.downloads.show();
      this.showMarks();
    }
    noteItem(note) {
      const of = [note.by, note.date && date(new Date(note.date)), note.of !== this.run.of && "of other pictures than these", note.marks?.length > 0 && plural(note.marks.length, "mark")];
      return h("li", {},
        h("button.at", { type: "button", title: `Show frame ${note.frame}`, onclick: () => this.viewer?.player.goToFrame(note.frame) }, `frame ${note.frame}`),
        h("span.note-text", {}, note.text, " ", h("small", {}, of.filter(Boolean).join(", "))),
        h("button.remove", { type: "button", "aria-label": `Remove the note at frame ${note.frame}`, onclick: () => review.decisions.remove(this.run, note) }, "×"));
    }
    // Call it when the viewer shows another frame.
    showFrame() {
      this.addButton.textContent = `Add note at frame ${this.frame}`;
      this.showMarks();
    }
    showMarks() {
      this.marks?.show(review.decisions.notes(this.run).filter(({ frame }) => frame === this.frame).flatMap(({ marks }) => marks ?? []));
    }

    toggleDrawing() {
      const on = this.drawButton.getAttribute("aria-pressed") !== "true";
      this.drawButton.setAttribute("aria-pressed", on);
      this.marks.drawing = on;
      if (on) this.viewer.player.pause();
    }
    typed(event) {
      if (event.key === "Escape") this.text.blur();
      if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) this.add();
    }
    add() {
      const text = this.text.value.trim(), lines = this.marks?.lines ?? [];
      if (!text && lines.length === 0) return this.text.focus();
      review.decisions.author = this.author.value.trim();
      this.text.value = "";
      this.marks?.clear();
      if (this.drawButton.getAttribute("aria-pressed") === "true") this.toggleDrawing();
      review.decisions.add(this.run, this.frame, text, lines);
    }
    async copy() {
      try {
        await navigator.clipboard.writeText(this.line.textContent);
        this.copied.textContent = "copied";
      } catch {
        getSelection().selectAllChildren(this.line); // if the browser denies access to the clipboard
        this.copied.textContent = "selected: copy it with the keys of your system";
      }
    }

    get keys() {
      const decide = (key, state) => ({ keys: [key], does: `decide: ${state}`, action: () => review.decisions.decide(this.run, state) });
      return [decide("a", "approved"), decide("w", "needs work"), decide("u", "open"),
        { keys: ["m"], does: "write a note (Ctrl Enter adds it)", action: () => this.text.focus() },
        this.marks && { keys: ["d"], does: "draw on the picture", action: () => this.toggleDrawing() }].filter(Boolean);
    }
    close() {
      this.listening.abort();
    }
  };
}
