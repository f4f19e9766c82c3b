"use strict";
const data = JSON.parse(document.getElementById("exploration").textContent);
const main = document.querySelector("main");
const node = (tag, attributes = {}, text = "") => {
  const made = document.createElement(tag);
  Object.entries(attributes).forEach(([name, value]) => made.setAttribute(name, value));
  made.textContent = text;
  return made;
};
const add = (parent, ...children) => { parent.append(...children); return parent; };

const count = data.frames.length;
const size = data.map.size;
const cells = size[0] * size[1];
const occupied = new Set(data.occupied);
// Reading with which a cell became known: -1 for the start of the arm, or `count + 1` for never.
const since = new Int32Array(cells).fill(count + 1);
data.surroundings.forEach((cell) => { since[cell] = -1; });
data.frames.forEach((frame, k) => frame.new.forEach((cell) => { since[cell] = k; }));
// Number of readings after which a configuration was known to be free.
const opened = new Int32Array(data.grid[0] * data.grid[1]).fill(count + 1);
data.opened.forEach(([readings, list]) => list.forEach((cell) => { opened[cell] = readings; }));

const heading = add(node("header"),
  node("h1", {}, data.title),
  node("p", { class: "status", "data-ending": data.status }, data.text));
const panel = (name, label) => {
  const canvas = node("canvas", { role: "img", "aria-label": label });
  return { canvas, figure: add(node("figure"), node("figcaption", {}, name), canvas) };
};
const left = panel("Workspace", "The map as far as it is known, the arm and what it sees");
const right = panel("Configuration space", "Configurations that are known to be free, and the path so far");
const chart = panel("Coverage of the map by path length", "Fraction of the map that has been seen, by path length");
chart.canvas.setAttribute("class", "chart");
const slider = node("input", { type: "range", min: 0, max: Math.max(count - 1, 0), value: 0, "aria-label": "Reading" });
const play = node("button", { class: "play", type: "button" });
const clock = node("span", { class: "clock" });
const readout = node("p", { class: "readout", "aria-live": "polite" });
const swatch = (color, name) => add(node("span"), node("span", { class: "swatch", style: `background:${color}` }), name);
const key = add(node("p", { class: "key" }),
  swatch("var(--paper)", "free"), swatch("var(--pale)", "unknown, solid"), swatch("var(--ink)", "occupied"),
  swatch("var(--channel)", "new"), swatch("var(--free)", "free configurations"));
add(main, heading, add(node("div", { class: "panels" }), left.figure, right.figure),
  add(node("div", { class: "transport" }), add(node("div", { class: "controls-of-time" }), play, slider, clock)), readout, chart.figure, key);

const color = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
/** Returns the font of text on canvases, which follows the text size of the page. */
const font = () => {
  const style = getComputedStyle(document.documentElement);
  return `${parseFloat(style.fontSize) * parseFloat(style.getPropertyValue("--type-small"))}px ${style.getPropertyValue("--font")}`;
};
const fitted = (canvas) => {
  const scale = window.devicePixelRatio || 1;
  canvas.width = Math.round(canvas.clientWidth * scale);
  canvas.height = Math.round(canvas.clientHeight * scale);
  const context = canvas.getContext("2d");
  context.setTransform(scale, 0, 0, scale, 0, 0);
  context.clearRect(0, 0, canvas.clientWidth, canvas.clientHeight);
  return context;
};
const polygon = (context, points) => {
  context.beginPath();
  points.forEach(([x, y], k) => (k ? context.lineTo(x, y) : context.moveTo(x, y)));
  context.closePath();
};

// Draws a rounded convex polygon: filled, with a border twice as wide as its radius.
const rounded = (context, [points, radius], place, scale) => {
  const at = points.map(place);
  if (at.length === 1) {
    context.beginPath();
    context.arc(at[0][0], at[0][1], radius * scale, 0, 7);
    context.fill();
    return;
  }
  polygon(context, at);
  context.fill();
  context.lineJoin = "round";
  context.lineCap = "round";
  context.lineWidth = 2 * radius * scale;
  if (radius > 0) context.stroke();
};

const drawWorkspace = (at) => {
  const context = fitted(left.canvas);
  const [width, height] = [left.canvas.clientWidth, left.canvas.clientHeight];
  const { origin, cell } = data.map;
  const scale = Math.min(width / (size[0] * cell), height / (size[1] * cell)) * 0.97;
  const place = ([x, y]) => [
    width / 2 + (x - origin[0] - size[0] * cell / 2) * scale,
    height / 2 - (y - origin[1] - size[1] * cell / 2) * scale,
  ];
  const side = cell * scale;
  const [x0, y0] = place([origin[0], origin[1] + size[1] * cell]);
  context.fillStyle = color("pale");
  context.fillRect(x0, y0, size[0] * side, size[1] * side);
  const fills = [color("paper"), color("ink"), color("channel")];
  for (let index = 0; index < cells; index += 1) {
    if (since[index] > at) continue;
    const kind = occupied.has(index) ? 1 : since[index] === at ? 2 : 0;
    context.fillStyle = fills[kind];
    // Slightly larger, to hide seams.
    context.fillRect(x0 + (index % size[0]) * side, y0 + Math.floor(index / size[0]) * side, side + 0.5, side + 0.5);
  }
  context.globalAlpha = 0.35;
  context.fillStyle = color("infeasible");
  context.strokeStyle = color("infeasible");
  data.obstacles.forEach((shape) => rounded(context, shape, place, scale));
  context.globalAlpha = 1;
  const frame = data.frames[at];
  const [sx, sy, ahead] = frame.sensor;
  const [cx, cy] = place([sx, sy]);
  const half = data.sensor.view / 2;
  context.globalAlpha = 0.12;
  context.fillStyle = color("accent");
  context.beginPath();
  if (half < Math.PI) context.moveTo(cx, cy);
  context.arc(cx, cy, data.sensor.range * scale, -(ahead + half), -(ahead - half));
  context.closePath();
  context.fill();
  context.globalAlpha = 0.85;
  frame.arm.forEach(([link, shape]) => {
    context.fillStyle = color(link ? "accent" : "edge");
    context.strokeStyle = context.fillStyle;
    rounded(context, shape, place, scale);
  });
  context.globalAlpha = 1;
  context.strokeStyle = color("accent");
  context.lineWidth = 1.5;
  context.beginPath();
  data.frames.slice(0, at + 1).forEach((f, k) => {
    const [x, y] = place(f.sensor);
    if (k) context.lineTo(x, y); else context.moveTo(x, y);
  });
  context.stroke();
  context.fillStyle = color("found");
  context.beginPath();
  context.arc(cx, cy, 4, 0, 7);
  context.fill();
};

const drawSpace = (at) => {
  const context = fitted(right.canvas);
  const [width, height] = [right.canvas.clientWidth, right.canvas.clientHeight];
  const [a, b] = data.axes;
  const side = Math.min(width, height) - 44;
  const [x0, y0] = [(width - side) / 2 + 10, (height - side) / 2 - 8];
  context.fillStyle = color("pale");
  context.fillRect(x0, y0, side, side);
  const [nx, ny] = data.grid;
  const [sx, sy] = [side / nx, side / ny];
  context.fillStyle = color("free");
  for (let index = 0; index < nx * ny; index += 1) {
    if (opened[index] > at + 1) continue;
    const [i, j] = [Math.floor(index / ny), index % ny];
    context.fillRect(x0 + i * sx, y0 + side - (j + 1) * sy, sx + 0.5, sy + 0.5);
  }
  const share = (axis, value) => {
    const extent = axis.upper - axis.lower;
    const part = (value - axis.lower) / extent;
    return part - Math.floor(Math.min(Math.max(part, -1e6), 1e6)) * (part < 0 || part > 1 ? 1 : 0);
  };
  const place = ([u, v]) => [x0 + share(a, u) * side, y0 + side - share(b, v) * side];
  context.strokeStyle = color("accent");
  context.lineWidth = 1.5;
  context.beginPath();
  let last = null;
  data.frames.slice(0, at + 1).forEach((frame) => {
    const [x, y] = place(frame.q);
    const jumps = last && Math.hypot(x - last[0], y - last[1]) > side / 2;
    if (last && !jumps) context.lineTo(x, y); else context.moveTo(x, y);
    last = [x, y];
  });
  context.stroke();
  context.fillStyle = color("found");
  context.beginPath();
  context.arc(last[0], last[1], 4, 0, 7);
  context.fill();
  context.fillStyle = color("grey");
  context.font = font();
  context.textAlign = "center";
  const shown = (axis) => {
    const degrees = axis.unit === "rad";
    const value = (v) => (degrees ? `${Math.round(v * 180 / Math.PI)}°` : `${+v.toFixed(2)} m`);
    return `${axis.name}, ${value(axis.lower)} to ${value(axis.upper)}`;
  };
  context.fillText(shown(a), x0 + side / 2, y0 + side + 17);
  context.save();
  context.translate(x0 - 8, y0 + side / 2);
  context.rotate(-Math.PI / 2);
  context.fillText(shown(b), 0, 0);
  context.restore();
};

const known = new Array(count).fill(0);
since.forEach((reading) => { if (reading <= count) known[Math.max(reading, 0)] += 1; });
for (let k = 1; k < count; k += 1) known[k] += known[k - 1];

// Place of each decision on the path, and its time; empty unless times were requested.
const decisions = (data.decisions_ms || []).map((time, k) => {
  const reading = Math.max(data.opened[k + 1][0] - 1, 0);
  return [data.frames[reading].length, time];
});
const drawChart = (at) => {
  const context = fitted(chart.canvas);
  const [x0, y0] = [48, 10];
  const [width, height] = [chart.canvas.clientWidth - x0 - 60, chart.canvas.clientHeight - y0 - 34];
  const whole = data.frames[count - 1].length || 1;
  const slowest = Math.max(...decisions.map(([, time]) => time), 1);
  const x = (length) => x0 + (length / whole) * width;
  const y = (share) => y0 + height * (1 - share);
  context.font = font();
  context.fillStyle = color("grey");
  context.strokeStyle = color("pale");
  context.lineWidth = 1;
  [0, 0.5, 1].forEach((share) => {
    context.textAlign = "right";
    context.fillText(`${100 * share} %`, x0 - 6, y(share) + 4);
    context.beginPath();
    context.moveTo(x0, y(share));
    context.lineTo(x0 + width, y(share));
    context.stroke();
    context.textAlign = "left";
    if (decisions.length) context.fillText(`${(slowest * share).toFixed(share ? 1 : 0)} ms`, x0 + width + 6, y(share) + 4);
  });
  context.textAlign = "center";
  context.fillText(decisions.length ? "path length; dots: time of each decision" : "path length", x0 + width / 2, y0 + height + 28);
  context.fillText("0", x0, y0 + height + 16);
  context.fillText(whole.toFixed(2), x0 + width, y0 + height + 16);
  context.globalAlpha = 0.5;
  decisions.forEach(([length, time]) => context.fillRect(x(length) - 1.5, y(time / slowest) - 1.5, 3, 3));
  context.globalAlpha = 1;
  context.strokeStyle = color("accent");
  context.lineWidth = 1.8;
  context.beginPath();
  data.frames.forEach((frame, k) => {
    const point = [x(frame.length), y(known[k] / cells)];
    if (k) context.lineTo(...point); else context.moveTo(...point);
  });
  context.stroke();
  context.fillStyle = color("found");
  context.beginPath();
  context.arc(x(data.frames[at].length), y(known[at] / cells), 4, 0, 7);
  context.fill();
};

const draw = () => {
  const at = Number(slider.value);
  drawWorkspace(at);
  drawSpace(at);
  drawChart(at);
  const frame = data.frames[at];
  clock.textContent = `reading ${at + 1} of ${count}`;
  const seen = (100 * known[at] / cells).toFixed(1);
  readout.textContent = `${seen} % of the map seen, ${frame.new.length} new cells; path length ${frame.length.toFixed(2)}`;
};
let timer = null;
/** Shows on the button what a click does. */
const mark = () => {
  const action = timer ? "pause" : "play";
  play.replaceChildren(icon(action));
  play.setAttribute("aria-label", action);
  play.title = `${action} (Space)`;
};
const stop = () => {
  clearInterval(timer);
  timer = null;
  mark();
};
const toggle = () => {
  if (timer) { stop(); return; }
  if (Number(slider.value) >= count - 1) slider.value = 0;
  timer = setInterval(() => {
    slider.value = Number(slider.value) + 1;
    draw();
    if (Number(slider.value) >= count - 1) stop();
  }, 80);
  mark();
};
mark();
play.addEventListener("click", toggle);
document.addEventListener("keydown", (event) => {
  const isControl = event.target.matches?.("button, input, select, textarea, a, summary");
  if (event.key !== " " || isControl || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  toggle();
});
slider.addEventListener("input", () => { if (timer) stop(); draw(); });
window.addEventListener("resize", draw);
window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
draw();
