"use strict";
const show = (id, text) => { document.getElementById(id).textContent = text; };
const token = new URLSearchParams(location.hash.slice(1)).get("token");
let rows = [], states = 0;

function light(colour, reason) {
  const box = document.getElementById("light");
  box.className = colour;
  box.textContent = colour === "none" ? reason : `${colour}: ${reason}`;
}

function welcome(message) {
  show("session", message.session ?? "none yet");
  const body = document.getElementById("joints");
  body.replaceChildren();
  rows = message.joints.map((name) => {
    const row = body.insertRow();
    row.insertCell().textContent = name;
    return { hand: name.endsWith("Hand"), cells: [row.insertCell(), row.insertCell(), row.insertCell()] };
  });
}

const angle = (value, hand) => value === null ? "–" : hand ? value.toFixed(2) : `${(Math.round(value * 1800 / Math.PI) / 10 + 0).toFixed(1)}°`;

function state(message) {
  states += 1;
  light(message.light.colour, message.light.reason);
  show("time", `${message.time.toFixed(1)} s${message.flags.length ? `, ${message.flags.join(", ")}` : ""}`);
  const frames = message.frames;
  show("frames", `${frames.received} received, ${frames.lost} lost, ${frames.late + frames.duplicate} late or twice, ` +
    `${frames.dropped} passed over, ${frames.refused} refused`);
  show("gesture", message.gesture ? `${message.gesture.label} (${Math.round(100 * message.gesture.confidence)} %)` : "–");
  show("similarity", message.similarity.error_deg === null ? "–" : `arms ${message.similarity.error_deg.toFixed(1)}° apart`);
  const columns = [message.requested, message.commanded, message.simulated];
  rows.forEach((row, joint) => columns.forEach((values, i) => { row.cells[i].textContent = angle(values[joint], row.hand); }));
}

function connect() {
  const scheme = location.protocol === "https:" ? "wss" : "ws";
  const socket = new WebSocket(`${scheme}://${location.host}/live`);
  socket.onopen = () => socket.send(JSON.stringify({ type: "hello", role: "observer", rate: 25, token }));
  socket.onmessage = (event) => {
    const message = JSON.parse(event.data);
    if (message.type === "welcome") { welcome(message); light("none", "connected; no robot moves yet"); }
    else if (message.type === "state") state(message);
    else if (message.type === "error") light("none", message.message);
  };
  socket.onclose = () => { if (!document.getElementById("light").textContent.startsWith("no token")) light("none", "not connected; trying again"); setTimeout(connect, 2000); };
}

setInterval(() => { show("rate", `${states} a second`); states = 0; }, 1000);
connect();
