// Where every body is at a moment: the arrays of the performance, and forward kinematics.

class Motion {
  constructor(told) {
    this.arrays = told.arrays;
    this.curves = told.curves;
    this.bodies = told.scene.bodies;
    [this.first, this.step, this.count] = told.curves.times;
    this.duration = this.first + this.step * (this.count - 1);
  }

  /** The moment before a time, and how far it is from there to the next, 0 to 1. */
  between(time) {
    const place = Math.min(Math.max((time - this.first) / this.step, 0), this.count - 1);
    const row = Math.min(Math.floor(place), Math.max(this.count - 2, 0));
    return [row, place - row];
  }

  nearest(time) {
    const [row, share] = this.between(time);
    return Math.min(row + Math.round(share), this.count - 1);
  }

  /** A row of an array at a time, between moments on the straight line. */
  at(name, time) {
    const { values, shape } = this.arrays[name];
    const [row, share] = this.between(time);
    const next = Math.min(row + 1, this.count - 1);
    return Array.from({ length: shape[1] }, (_, i) => {
      const a = values[row * shape[1] + i];
      return share ? a + share * (values[next * shape[1] + i] - a) : a;
    });
  }

  row(name, index) {
    const { values, shape } = this.arrays[name];
    return values.subarray(index * shape[1], (index + 1) * shape[1]);
  }

  recordingTime(time) {
    return (time - this.curves.motion_start) * this.curves.speed;
  }

  rolloutTime(recordingTime) {
    return this.curves.motion_start + recordingTime / this.curves.speed;
  }

  /** Poses [x, y, z, qw, qx, qy, qz] of all bodies; those of the robot as it was, or as was requested. */
  poses(time, requested = false) {
    const joints = this.at("joint_positions", time);
    if (requested) {
      const asked = this.row("requested", this.nearest(time)), told = this.at("command", time);
      joints.forEach((_, i) => (joints[i] = Number.isFinite(asked[i]) ? asked[i] : told[i]));
    }
    const base = posed(this.at("base_pose", time));
    const person = this.arrays.person && this.row("person", this.nearest(time));
    const poses = [];
    for (const body of this.bodies) poses.push(this.pose(body, poses[body.parent], joints, base, person));
    return poses;
  }

  pose({ place, joint }, parent, joints, base, person) {
    if (joint?.base) return base;
    if (joint?.person !== undefined) return posed(person.subarray(joint.person, joint.person + 7));
    if (!parent) return place;
    const q = parent.slice(3);
    let turn = turned(q, place.slice(3));
    if (joint) turn = turned(turn, turnAbout(joint.axis, joints[joint.source] * joint.ratio));
    return [...add(parent.slice(0, 3), rotate(q, place.slice(0, 3))), ...turn];
  }

  /** Points [x, y, z] where the robot touches something. */
  contacts(time) {
    const row = this.nearest(time);
    const counts = this.arrays.contact_counts.values;
    if (!this.firstContact) {
      let sum = 0;
      this.firstContact = Array.from(counts, (count) => (sum += count) - count);
    }
    const points = this.arrays.contact_points.values;
    return Array.from({ length: counts[row] }, (_, i) => Array.from(points.subarray(3 * (this.firstContact[row] + i), 3 * (this.firstContact[row] + i) + 3)));
  }

  /** Covers [r, g, b, a] of the robot's parts (colours times opacity), and the words that hold. */
  safety(time) {
    const row = this.row("tint", this.nearest(time));
    const parts = this.curves.parts;
    const covers = Array.from({ length: parts }, (_, i) => Array.from(row.subarray(4 * i, 4 * i + 4), (value) => value / 255));
    return { covers, words: this.curves.words.filter((_, i) => row[4 * parts + i] > 0) };
  }
}

/** A pose whose turn, rounded or between two moments, is of length one again. */
const posed = ([x, y, z, ...turn]) => [x, y, z, ...unit(turn)];
