// The picture area with its controls. Shows one run, or two runs: side by side, divided by a slider, alternating, or as
// their difference.
"use strict";
{
  const { h, svg } = review;
  const { number, time, plural } = review.format;

  const MODES = [
    { id: "single", name: "Single", key: "1" },
    { id: "side", name: "Side by side", key: "2" },
    { id: "slider", name: "Slider", key: "3" },
    { id: "blink", name: "Blink", key: "4" },
    { id: "difference", name: "Difference", key: "5" },
    { id: "heat", name: "Heat map", key: "6" }, // FLIP map; only for pictures that were compared with the reference
  ];
  const RATES = [0.1, 0.25, 0.5, 1, 2];
  const GAINS = [1, 4, 16];
  const BLINK_MS = 500;
  // Colour scale of the difference, from none to the largest. Its lightness increases, so it needs no colour vision.
  const HEAT = [[0, 0, 0.03], [0.26, 0.04, 0.41], [0.58, 0.15, 0.4], [0.87, 0.32, 0.23], [0.99, 0.65, 0.04], [1, 1, 0.75]];

  // SVG filter that shows the mean of the three channels, times the gain, as a colour of HEAT.
  const heatFilter = (gain) => {
    const row = `${gain / 3} ${gain / 3} ${gain / 3} 0 0`;
    const table = (channel) => ({ type: "table", tableValues: HEAT.map((color) => color[channel]).join(" ") });
    return svg("filter", { id: `heat-${gain}`, "color-interpolation-filters": "sRGB", x: 0, y: 0, width: "100%", height: "100%" },
      svg("feColorMatrix", { type: "matrix", values: `${row} ${row} ${row} 0 0 0 1 0` }),
      svg("feComponentTransfer", {}, svg("feFuncR", table(0)), svg("feFuncG", table(1)), svg("feFuncB", table(2))));
  };

  const ICONS = {
    first: "M3 3v10M13 3 6 8l7 5z",
    back: "M11 3 4 8l7 5z",
    play: "M4 2.5v11L13 8z",
    pause: "M4 3h3v10H4zM9 3h3v10H9z",
    on: "M5 3l7 5-7 5z",
    last: "M13 3v10M3 3l7 5-7 5z",
  };
  const icon = (name) => svg("svg", { viewBox: "0 0 16 16", "aria-hidden": "true", class: "icon" }, svg("path", { d: ICONS[name] }));

  // Pictures of the first run in which cloth is in a pinched region (no space between bodies), as ranges [first, last].
  const pinchedRanges = (run) => {
    const ranges = [];
    for (let picture = 0; picture < run.pictures.count; ++picture) {
      if (!(run.valueAt("pinched_pairs", run.frameOf(picture)) > 0)) continue;
      const last = ranges.at(-1);
      if (last && last[1] === picture - 1) last[1] = picture;
      else ranges.push([picture, picture]);
    }
    return ranges;
  };

  review.Viewer = class {
    /** `other`: the second run; may be null. `mode`: one of MODES; used only if there is a second run. */
    constructor(lead, other, { mode = "slider", onMode = () => {} } = {}) {
      this.runs = other ? [lead, other] : [lead];
      this.onMode = onMode;
      this.player = new review.Player(this.runs);
      this.build();
      this.setMode(other ? mode : "single");
      this.setGain(4);
      this.setSplit(50);
      this.player.addEventListener("picture", () => this.update());
      this.player.addEventListener("state", () => this.updateState());
      this.player.addEventListener("count", () => this.updateCount());
      this.player.addEventListener("error", (event) => {
        this.message.textContent = event.detail;
        this.message.hidden = false;
      });
      this.updateCount();
      this.updateState();
    }

    get hasPair() {
      return this.runs.length > 1;
    }
    get modes() {
      if (!this.hasPair) return MODES.slice(0, 1);
      const [lead, other] = this.runs;
      return lead.comparison.length > 0 && other === lead.reference ? MODES : MODES.slice(0, -1);
    }

    build() {
      this.layers = this.player.tracks.map((track, i) =>
        h(`div.layer.layer-${"ab"[i]}`, {}, track.element));
      this.split = h("input.split", { type: "range", min: 0, max: 100, step: 0.5, "aria-label": "Position of the slider",
        oninput: () => this.setSplit(Number(this.split.value)) });
      this.heat = h("img.heat", { alt: "" });
      this.heatNote = h("p.heat-note");
      this.blend = h("div.blend", { style: { "aspect-ratio": this.runs[0].aspect } }, this.layers);
      this.message = h("p.stage-message", { role: "alert", hidden: true });
      this.names = h("div.names", { "aria-hidden": "true" }, this.runs.map((run, i) => h(`span.name-${"ab"[i]}`, {}, run.label)));
      this.stage = h("div.stage", {}, this.blend, this.hasPair && [h("div.split-line"), this.split, this.names, this.heat, this.heatNote], this.message);
      this.followPointer();
      this.element = h("section.viewer", { "aria-label": "Pictures" },
        svg("svg", { width: 0, height: 0, "aria-hidden": "true", class: "filters" }, GAINS.map(heatFilter)),
        this.hasPair && this.buildModes(), this.stage, this.buildTransport(), this.buildSheet());
    }

    buildModes() {
      this.modeButtons = this.modes.map(({ id, name, key }) =>
        h("button", { type: "button", title: `${name} (${key})`, "data-mode": id, onclick: () => this.setMode(id) }, name));
      this.gainSelect = h("select", { "aria-label": "Gain of the difference", title: "Mean of the three channels, in levels of 255", onchange: () => this.setGain(Number(this.gainSelect.value)) },
        GAINS.map((gain) => h("option", { value: gain }, `× ${gain}`)));
      this.legend = h("span.heat-legend", {}, "0 ", h("i", { style: { background:
        `linear-gradient(90deg, ${HEAT.map((color) => `rgb(${color.map((part) => Math.round(255 * part)).join(" ")})`).join(", ")})` } }), " ", h("b"));
      this.gainTools = h("span.gain", {}, this.gainSelect, this.legend);
      return h("div.modes", {}, h("div.segments", { role: "group", "aria-label": "How the two are shown" }, this.modeButtons), this.gainTools);
    }

    buildTransport() {
      const button = (label, title, action) => h("button", { type: "button", "aria-label": title, title, onclick: action }, label);
      this.playButton = button(null, "Play (Space)", () => this.player.toggle());
      this.frameInput = h("input.frame-number", { type: "number", "aria-label": "Frame", onchange: () => this.player.goToFrame(Number(this.frameInput.value)),
        onkeydown: (event) => event.key === "Escape" && this.frameInput.blur() });
      this.lastFrame = h("span");
      this.clock = h("span.clock");
      this.rate = h("select", { "aria-label": "Speed", onchange: () => this.player.setRate(Number(this.rate.value)) },
        RATES.map((rate) => h("option", { value: rate, selected: rate === 1 }, `${rate} ×`)));
      this.loop = h("input", { type: "checkbox", onchange: () => this.player.setLoop(this.loop.checked) });
      this.scrubber = h("input.scrubber", { type: "range", min: 0, step: 1, value: 0, "aria-label": "Frame of the video",
        oninput: () => this.player.go(Number(this.scrubber.value)) });
      this.marks = h("div.marks", { "aria-hidden": "true" });
      return h("div.transport", {},
        h("div.track", {}, this.scrubber, this.marks),
        h("div.controls", {},
          h("div.buttons", {},
            button(icon("first"), "First frame (Home)", () => this.player.go(0)),
            button(icon("back"), "One frame back (←)", () => this.player.step(-1)),
            this.playButton,
            button(icon("on"), "One frame on (→)", () => this.player.step(1)),
            button(icon("last"), "Last frame (End)", () => this.player.go(Infinity))),
          h("label.place", {}, "frame ", this.frameInput, this.lastFrame), this.clock,
          h("label", {}, this.rate), h("label.loop", {}, this.loop, " loop")));
    }

    buildSheet() {
      const lead = this.runs[0];
      this.tiles = lead.sheet.map(({ picture, file }) =>
        h("button.tile", { type: "button", "data-picture": picture, title: `Frame ${lead.frameOf(picture)}, ${time(lead.timeOf(picture))}`, onclick: () => this.player.go(picture) },
          h("img", { src: file, alt: "", loading: "lazy" }), h("span", {}, lead.frameOf(picture)), this.likenessMark(picture)));
      return this.tiles.length > 0 && h("div.sheet", { role: "group", "aria-label": "Contact sheet" }, this.tiles);
    }

    // The mark below a tile that says whether its picture matches the reference.
    likenessMark(picture) {
      const [lead, other] = this.runs;
      const pair = other && other === lead.reference && lead.comparison.find((entry) => entry.picture === picture);
      return pair && h(`i.${pair.verdict}`, { title: `${pair.verdict}: FLIP ${number(pair.flip, 3)}, SSIM ${number(pair.ssim, 4)}` });
    }

    followPointer() {
      const move = (event) => {
        if (this.mode !== "slider" || event.target === this.split || event.buttons === 0) return;
        if (event.type === "pointerdown") this.stage.setPointerCapture(event.pointerId); // to receive moves outside of the element too
        const box = this.blend.getBoundingClientRect();
        this.setSplit((100 * (event.clientX - box.left)) / box.width);
      };
      this.stage.addEventListener("pointerdown", move);
      this.stage.addEventListener("pointermove", move);
    }

    setMode(mode) {
      const { modes } = this;
      this.mode = (modes.find(({ id }) => id === mode) ?? modes.find(({ id }) => id === "slider") ?? modes[0]).id;
      this.stage.dataset.mode = this.mode;
      clearInterval(this.blinking);
      delete this.stage.dataset.blink;
      if (this.mode === "blink") this.blinking = setInterval(() => this.blinkOnce(), BLINK_MS);
      if (!this.hasPair) return;
      for (const button of this.modeButtons) button.setAttribute("aria-pressed", button.dataset.mode === this.mode);
      this.gainTools.hidden = this.mode !== "difference";
      if (this.mode === "heat") this.showHeat();
      this.onMode(this.mode);
    }
    blinkOnce() {
      this.stage.dataset.blink = this.stage.dataset.blink === "b" ? "a" : "b";
    }
    // Shows the heat map of the compared picture that is nearest to the current one.
    showHeat() {
      const lead = this.runs[0];
      const pair = lead.comparedNear(this.player.picture);
      this.heat.hidden = !pair.heat;
      if (pair.heat) this.heat.src = pair.heat;
      const figures = pair.heat ? `FLIP ${number(pair.flip, 3)}, SSIM ${number(pair.ssim, 4)}, largest difference ${pair.largest} of 255` : "equal in every pixel";
      this.heatNote.textContent = `frame ${lead.frameOf(pair.picture)}: ${figures}`;
    }
    setGain(gain) {
      this.blend.style.setProperty("--heat", `url(#heat-${gain})`);
      if (!this.hasPair) return;
      this.gainSelect.value = gain;
      this.legend.lastChild.textContent = `${Math.round(255 / gain)} levels`;
    }
    setSplit(percent) {
      const value = Math.max(0, Math.min(100, percent));
      this.stage.style.setProperty("--split", `${value}%`);
      this.split.value = value;
      this.split.setAttribute("aria-valuetext", `${Math.round(value)} % ${this.runs[0].label}`);
    }

    update() {
      const { player, scrubber } = this;
      const run = player.lead.run;
      scrubber.value = player.picture;
      scrubber.setAttribute("aria-valuetext", `frame ${player.frame}, ${time(player.time)}`);
      if (document.activeElement !== this.frameInput) this.frameInput.value = player.frame;
      this.clock.textContent = time(player.time);
      let current = null;
      for (const tile of this.tiles) {
        tile.removeAttribute("aria-current");
        if (Number(tile.dataset.picture) <= player.picture) current = tile;
      }
      current?.setAttribute("aria-current", "true");
      if (this.mode === "heat") this.showHeat();
      this.element.dataset.frame = player.frame;
    }
    updateState() {
      const { playing, rate, loop } = this.player;
      this.playButton.replaceChildren(icon(playing ? "pause" : "play"));
      this.playButton.setAttribute("aria-label", playing ? "Pause (Space)" : "Play (Space)");
      this.rate.value = rate;
      this.loop.checked = loop;
    }
    updateCount() {
      const run = this.player.lead.run;
      const last = Math.max(0, run.pictures.count - 1);
      this.scrubber.max = last;
      this.frameInput.min = run.frameOf(0);
      this.frameInput.max = run.frameOf(last);
      this.lastFrame.textContent = ` / ${run.frameOf(last)}`;
      const width = 100 / Math.max(1, run.pictures.count);
      this.marks.replaceChildren(...pinchedRanges(run).map(([first, end]) =>
        h("i", { style: { left: `${first * width}%`, width: `${(end - first + 1) * width}%` } })));
      this.marks.title = this.marks.children.length > 0 ? `${plural(this.marks.children.length, "stretch")} with pinched cloth` : "";
      this.update();
    }

    changeRate(steps) {
      const at = RATES.indexOf(this.player.rate) + steps;
      if (at >= 0 && at < RATES.length) this.player.setRate(RATES[at]);
    }

    get keys() {
      const { player } = this;
      const keys = (list, does, action) => ({ keys: list, does, action });
      const modes = this.modes.map(({ id, name, key }) => keys([key], name, () => this.setMode(id)));
      return [
        keys([" ", "k"], "play or pause", () => player.toggle()),
        keys(["ArrowLeft", ","], "one frame back", () => player.step(-1)),
        keys(["ArrowRight", "."], "one frame on", () => player.step(1)),
        keys(["Shift+ArrowLeft"], "ten frames back", () => player.step(-10)),
        keys(["Shift+ArrowRight"], "ten frames on", () => player.step(10)),
        keys(["Home"], "first frame", () => player.go(0)),
        keys(["End"], "last frame", () => player.go(Infinity)),
        keys(["g"], "go to a frame: type its number", () => this.frameInput.select()),
        keys(["<"], "slower", () => this.changeRate(-1)),
        keys([">"], "faster", () => this.changeRate(1)),
        keys(["l"], "loop", () => player.setLoop(!player.loop)),
        keys(["f"], "full screen", () => (document.fullscreenElement ? document.exitFullscreen() : this.stage.requestFullscreen())),
        ...(this.hasPair ? modes : []),
        this.hasPair && keys(["b"], "other one of the two at once (in Blink: by hand)", () => {
          if (this.mode !== "blink") this.setMode("blink");
          clearInterval(this.blinking);
          this.blinkOnce();
        }),
        this.hasPair && keys(["["], "slider to the left", () => this.setSplit(Number(this.split.value) - 5)),
        this.hasPair && keys(["]"], "slider to the right", () => this.setSplit(Number(this.split.value) + 5)),
      ].filter(Boolean);
    }

    close() {
      clearInterval(this.blinking);
      this.player.close();
    }
  };
}
