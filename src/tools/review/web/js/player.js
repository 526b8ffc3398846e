// Shows the pictures of one run, or of several at the same time. Each run has a track. The first track sets the time of
// the other tracks.
"use strict";
{
  const { h } = review;

  // Browsers give no reason, or only a technical one, for a video that they do not play.
  const REASONS = { 1: "it was interrupted", 2: "the file cannot be read", 3: "the file is damaged", 4: "the file is not there, or this browser does not know how its pictures are coded" };
  const reasonOf = (error) => [REASONS[error?.code] ?? "unknown reason", error?.message].filter(Boolean).join("; ");

  // A video of constant frame rate. Picture k lasts from k / fps to (k + 1) / fps. The player seeks the middle, so that
  // rounding cannot select a neighbour. The attribute data-picture is the index of the picture on screen.
  class VideoTrack {
    constructor(run, { onCount, onError }) {
      this.run = run;
      this.wanted = 0;
      this.sought = null; // picture that the browser seeks
      this.element = h("video", { preload: "auto", playsinline: true, disablepictureinpicture: true, tabindex: -1, "aria-label": `Video of ${run.label}` });
      this.element.muted = true;
      this.element.addEventListener("loadedmetadata", () => {
        if (run.pictures.count === 0) {
          run.pictures.count = Math.max(1, Math.round(this.element.duration * run.fps));
          onCount();
        }
        this.seek();
      });
      this.element.addEventListener("seeked", () => this.settle());
      this.element.addEventListener("error", () => onError(run, `${run.pictures.files[0]}: ${reasonOf(this.element.error)}`));
      this.element.src = run.pictures.files[0];
    }

    show(picture) {
      this.wanted = picture;
      if (this.sought === null && this.element.readyState > 0) this.seek();
    }
    // Starts only one seek at a time, since a reader moves the scrubber faster than the browser seeks.
    seek() {
      this.sought = this.wanted;
      this.element.currentTime = (this.sought + 0.5) / this.run.fps;
    }
    settle() {
      const found = this.sought;
      this.sought = null;
      if (found !== this.wanted && this.element.paused) this.seek();
      else if (found !== null) this.element.dataset.picture = found;
    }

    play(rate, onPicture, onEnd) {
      const { element } = this;
      element.playbackRate = rate;
      element.onended = onEnd;
      element.play().catch(() => {}); // play() fails if the video is paused before it starts
      const report = (time) => {
        if (element.paused) return;
        this.wanted = Math.min(this.run.pictures.count - 1, Math.max(0, time));
        element.dataset.picture = this.wanted;
        onPicture?.(this.wanted);
        await_next();
      };
      const await_next = element.requestVideoFrameCallback
        ? () => element.requestVideoFrameCallback((_, { mediaTime }) => report(Math.round(mediaTime * this.run.fps)))
        : () => requestAnimationFrame(() => report(Math.floor(element.currentTime * this.run.fps)));
      await_next();
    }
    // While playing, corrects the time only if it is off by more than one picture.
    stayNear(picture) {
      const behind = picture + 0.5 - this.element.currentTime * this.run.fps;
      if (Math.abs(behind) > 1.5 && this.sought === null) this.show(picture);
    }
    pause() {
      this.element.onended = null;
      this.element.pause();
    }
    close() {
      this.pause();
      this.element.removeAttribute("src");
      this.element.load();
    }
  }

  // Numbered pictures.
  class StillsTrack {
    constructor(run, { onError }) {
      this.run = run;
      this.element = h("img", { alt: `Picture of ${run.label}`, draggable: "false" });
      this.element.addEventListener("load", () => (this.element.dataset.picture = this.wanted));
      this.element.addEventListener("error", () => onError(run, "a picture cannot be read"));
    }
    show(picture) {
      this.wanted = picture;
      this.element.src = this.run.pictures.files[picture];
      new Image().src = this.run.pictures.files[Math.min(picture + 1, this.run.pictures.files.length - 1)];
    }
    play(rate, onPicture, onEnd) {
      if (!onPicture) return; // if this is not the first track, stayNear() shows the pictures
      const first = this.wanted;
      let start = null;
      const tick = (now) => {
        start ??= now;
        const picture = first + Math.floor(((now - start) / 1e3) * this.run.fps * rate);
        if (picture >= this.run.pictures.count) return onEnd();
        if (picture !== this.wanted) {
          this.show(picture);
          onPicture(picture);
        }
        this.timer = requestAnimationFrame(tick);
      };
      this.timer = requestAnimationFrame(tick);
    }
    stayNear(picture) {
      if (picture !== this.wanted) this.show(picture);
    }
    pause() {
      cancelAnimationFrame(this.timer);
    }
    close() {
      this.pause();
    }
  }

  /** Events: "picture" (another one is shown), "state" (playing, rate or loop changed), "count", "error". */
  review.Player = class extends EventTarget {
    constructor(runs) {
      super();
      const reports = {
        onCount: () => this.tell("count"),
        onError: (run, reason) => this.dispatchEvent(new CustomEvent("error", { detail: `${run.label}: the video cannot be played: ${reason}` })),
      };
      this.tracks = runs.map((run) => (run.pictures.kind === "video" ? new VideoTrack(run, reports) : new StillsTrack(run, reports)));
      this.picture = 0;
      this.playing = false;
      this.rate = 1;
      this.loop = false;
    }

    tell(name) {
      this.dispatchEvent(new Event(name));
    }
    get lead() {
      return this.tracks[0];
    }
    get count() {
      return this.lead.run.pictures.count;
    }
    get frame() {
      return this.lead.run.frameOf(this.picture);
    }
    get time() {
      return this.lead.run.timeOf(this.picture);
    }

    go(picture) {
      this.halt();
      this.picture = Math.max(0, Math.min(Math.max(0, this.count - 1), Math.round(picture)));
      this.lead.show(this.picture);
      for (const track of this.tracks.slice(1)) track.show(track.run.pictureAt(this.time));
      this.tell("picture");
    }
    goToFrame(frame) {
      this.go(this.lead.run.pictureOfFrame(frame));
    }
    goToTime(time) {
      this.go(this.lead.run.pictureAt(time));
    }
    step(pictures) {
      this.go(this.picture + pictures);
    }

    play() {
      if (this.picture >= this.count - 1) this.go(0);
      this.playing = true;
      const onPicture = (picture) => {
        this.picture = picture;
        for (const track of this.tracks.slice(1)) track.stayNear(track.run.pictureAt(this.time));
        this.tell("picture");
      };
      const onEnd = () => {
        if (this.loop) {
          this.go(0);
          this.play();
        } else this.go(this.count - 1);
      };
      this.lead.play(this.rate, onPicture, onEnd);
      for (const track of this.tracks.slice(1)) track.play(this.rate);
      this.tell("state");
    }
    halt() {
      if (!this.playing) return;
      this.playing = false;
      for (const track of this.tracks) track.pause();
      this.tell("state");
    }
    pause() {
      this.go(this.picture); // moves every track to exactly this picture
    }
    toggle() {
      this.playing ? this.pause() : this.play();
    }
    setRate(rate) {
      this.rate = rate;
      this.restart();
    }
    setLoop(loop) {
      this.loop = loop;
      this.tell("state");
    }
    restart() {
      if (this.playing) {
        this.halt();
        this.play();
      } else this.tell("state");
    }
    close() {
      this.halt();
      for (const track of this.tracks) track.close();
    }
  };
}
