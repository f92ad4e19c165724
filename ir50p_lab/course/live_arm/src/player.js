// A motion over time: played, scrubbed, or followed live while a bench moves.
import { Curves } from "./curves.js";
import { playerBar, showLegend } from "./page.js";
import { COLOURS } from "./robot.js";
import { Track } from "./track.js";

export class Player {
  constructor(view) {
    Object.assign(this, { view, playing: false, isLive: false, rate: 1 });
    const { parts, options } = view;
    this.showBar = playerBar(parts.player, {
      toggle: () => this.toggle(),
      seek: (part) => this.seek(this.track.start + part * (this.track.end - this.track.start)),
      speed: (rate) => { this.rate = rate; },
    });
    this.curves = new Curves(options.in_space ? null : view.limits, view.l, (t) => this.seek(t));
    parts.side.append(this.curves.canvas, this.curves.cursor);
  }

  load() {
    const { model, scene, hand } = this.view, bytes = model.get("track");
    this.isLive = false;
    hand.reset();
    this.pause();
    this.take(bytes?.byteLength ? new Track(bytes, model.get("shape")) : null);
    if (!this.track) return;
    this.rate = model.get("options").speed;
    this.seek(this.track.start);
    if (scene.width && !scene.turned) scene.lookFromStart();
  }

  take(track) {
    const { scene, parts, hand, l } = this.view;
    this.track = scene.track = track?.rows ? track : null;
    parts.player.hidden = parts.side.hidden = !this.track;
    const runs = this.track?.runs ?? [];
    scene.placeOthers(null, null);
    const every = this.isLive ? 4 : 1; // a full trail, new in each picture, takes half of the drawing
    scene.trails.forEach((trail, k) => trail.set(runs[k] ? this.track.path(l, runs[k].q, every) : k ? [] : hand.written));
    if (this.track) this.curves.load(this.track);
    scene.trails[0].material.color.set(runs.length > 1 ? COLOURS.upper : COLOURS.trail);
    const chips = runs.length > 1 ? [["#0072B2", runs[0].label], [COLOURS.second, runs[1].label]] : runs.map((run) => [null, run.label]);
    const words = this.track?.source ? [[null, this.track.source]] : [];
    const wanted = runs[0]?.reference != null ? [["#8a8f9888", "set point"]] : [];
    showLegend(parts.legend, [...chips, ...wanted, ...words]);
    this.view.resize();
  }

  // A window of samples that has just come: show the last. mostPush: N that a hand may push.
  live(track, mostPush) {
    const { on, hand } = this.view;
    if (!this.isLive) on.add("trail");
    this.isLive = true;
    this.playing = false;
    hand.mayPush(mostPush);
    this.take(track);
    if (this.track) this.seek(this.track.end);
    hand.stillPushes();
  }

  seek(t) {
    const { track } = this, { scene } = this.view, [first, second] = track.runs;
    this.time = Math.min(Math.max(t, track.start), track.end);
    const row = track.row(this.time);
    scene.trails.forEach((trail) => trail.show(row + 1));
    scene.placeOthers(first.reference === null ? null : track.at(this.time, first.reference), second ? track.at(this.time, second.q) : null);
    this.view.pose(track.at(this.time, first.q));
    this.tell();
  }

  tell() {
    const { track, time, playing, isLive, rate } = this;
    this.showBar({ t: time, start: track.start, end: track.end, playing, live: isLive, rate });
  }

  play() {
    if (this.time >= this.track.end) this.time = this.track.start;
    this.playing = true;
    let last = null;
    const tick = (now) => {
      if (!this.playing || this.view.scene.closed) return;
      const next = this.time + (last === null ? 0 : ((now - last) / 1000) * this.rate);
      last = now;
      if (next >= this.track.end) this.playing = false;
      this.seek(next);
      if (this.playing) requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  toggle() {
    this.playing ? this.pause() : this.play();
  }

  pause() {
    if (!this.playing) return;
    this.playing = false;
    this.tell();
    this.view.tell();
  }

  draw(width, height) {
    if (this.track) this.curves.draw(this.time, width, height);
  }
}
