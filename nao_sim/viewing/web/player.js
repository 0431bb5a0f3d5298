// Which moment is shown: a player's buttons, with the rules of nao_sim/viewing/playback.py.

class Player {
  constructor(duration, speeds, layers) {
    Object.assign(this, { duration, speeds, time: 0, speed: 1, playing: true });
    this.shown = new Set(layers.filter((layer) => layer.shown).map((layer) => layer.name));
  }

  advance(elapsed) {
    if (!this.playing) return;
    this.seek(this.time + this.speed * elapsed);
    this.playing = this.time < this.duration;
  }

  toggle() {
    if (!this.playing && this.time >= this.duration) this.time = 0;
    this.playing = !this.playing;
  }

  seek(time) {
    this.time = Math.min(Math.max(time, 0), this.duration);
  }

  jump(seconds) {
    this.seek(this.time + seconds);
    this.playing = false;
  }

  changeSpeed(places) {
    const place = this.speeds.indexOf(this.speed) + places;
    this.speed = this.speeds[Math.min(Math.max(place, 0), this.speeds.length - 1)];
  }

  show(layer) {
    if (!this.shown.delete(layer)) this.shown.add(layer);
  }
}
