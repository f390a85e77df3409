(() => {
  const root = document.getElementById("viewer");
  const canvas = root.querySelector("canvas"), ink = canvas.getContext("2d");
  const [button, slider, speed, text] = ["button", "input", "select", "span"].map(name => root.querySelector(name));
  const frames = run.frames, end = frames[frames.length - 1][0];
  const SIDE = 620, HIGH = canvas.height, SCALE = 620, GROUND = 350, COLOURS = ["#0969da", "#bc4c00"];
  let now = 0, playing = false, before = 0;

  // A vector of the body in world axes.
  const turned = ([w, x, y, z], v) => {
    const a = [y * v[2] - z * v[1], z * v[0] - x * v[2], x * v[1] - y * v[0]];
    const b = [y * a[2] - z * a[1], z * a[0] - x * a[2], x * a[1] - y * a[0]];
    return v.map((part, i) => part + 2 * (w * a[i] + b[i]));
  };
  const height = (profile, x) => {
    let last = null;
    for (const point of profile) {
      if (x < point[0]) return last ? last[1] + (point[1] - last[1]) * (x - last[0]) / (point[0] - last[0]) : point[1];
      last = point;
    }
    return last[1];
  };
  const indexAt = t => {
    let low = 0, high = frames.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (frames[middle][0] <= t) low = middle; else high = middle - 1;
    }
    return low;
  };
  const stroke = (points, colour, width, fill) => {
    ink.beginPath();
    points.forEach(([u, v], i) => i ? ink.lineTo(u, v) : ink.moveTo(u, v));
    if (fill) { ink.closePath(); ink.fillStyle = fill; ink.fill(); }
    ink.strokeStyle = colour; ink.lineWidth = width; ink.lineCap = "round"; ink.lineJoin = "round"; ink.stroke();
  };
  const robot = (frame, project, top) => {
    const q = frame.slice(4, 8), place = frame.slice(1, 4);
    const at = v => project(turned(q, v).map((part, i) => part + place[i]));
    const wheel = side => {
      const first = 8 + 7 * side, y = (side ? -1 : 1) * run.track / 2;
      const centre = [frame[first + 4], y, frame[first + 5]], r = run.radius, angle = frame[first + 6];
      const rim = across => Array.from({length: 33}, (_, i) => {
        const a = i * Math.PI / 16;
        return at([centre[0] + r * Math.cos(a), y + across, centre[2] + r * Math.sin(a)]);
      });
      stroke(rim(run.width / 2), COLOURS[side], 1.5, COLOURS[side] + "22");
      stroke(rim(-run.width / 2), COLOURS[side], 1.5, COLOURS[side] + "22");
      for (let i = 0; i < 3; i++) {
        const a = angle + i * 2 * Math.PI / 3;
        stroke([at(centre), at([centre[0] + r * Math.cos(a), y, centre[2] - r * Math.sin(a)])], COLOURS[side], 1);
      }
    };
    const leg = side => {
      const first = 8 + 7 * side, y = (side ? -1 : 1) * run.plane, half = run.gap / 2;
      const axle = [frame[first + 4], y, frame[first + 5]];
      [0, 1].forEach(rear => stroke([
        at([rear ? -half : half, y, 0]), at([frame[first + 2 * rear], y, frame[first + 2 * rear + 1]]), at(axle),
      ], COLOURS[side], 5));
      wheel(side);
    };
    const body = () => {
      const [lx, ly, lz, cx, cy, cz] = run.box;
      const corner = (i, j, k) => at([cx + i * lx / 2, cy + j * ly / 2, cz + k * lz / 2]);
      const face = (corners, fill) => stroke([...corners, corners[0]], "#24292f", 1.2, fill);
      for (const j of [1, -1]) face([[-1, j, -1], [1, j, -1], [1, j, 1], [-1, j, 1]].map(c => corner(...c)), "#d0d7deaa");
      for (const k of [-1, 1]) face([[-1, -1, k], [1, -1, k], [1, 1, k], [-1, 1, k]].map(c => corner(...c)), "#d0d7de66");
      face([[1, -1, -1], [1, 1, -1], [1, 1, 1], [1, -1, 1]].map(c => corner(...c)), "#1a7f3755");
    };
    if (top) { leg(0); leg(1); body(); } else { leg(0); body(); leg(1); }
  };
  const draw = () => {
    const number = indexAt(now), frame = frames[number], [t, x, y, z] = frame, q = frame.slice(4, 8);
    const nose = turned(q, [1, 0, 0]), yaw = Math.atan2(nose[1], nose[0]), cos = Math.cos(yaw), sin = Math.sin(yaw);
    ink.clearRect(0, 0, canvas.width, HIGH);
    ink.save(); ink.beginPath(); ink.rect(0, 0, SIDE, HIGH); ink.clip();
    const floor = Math.min(...run.ground.map(profile => height(profile, x)));
    const side = p => [SIDE / 2 + SCALE * ((p[0] - x) * cos + (p[1] - y) * sin), GROUND - SCALE * (p[2] - floor)];
    run.ground.forEach((profile, i) => stroke(Array.from({length: 121}, (_, k) => {
      const ahead = (k - 60) / 120 * 1.1, px = x + ahead * cos, py = y + ahead * sin;
      return side([px, py, height(profile, px)]);
    }), i ? "#57606a" : "#8c959f", 2));
    // Marks every 20 cm of the way, so that one sees the ground pass.
    const way = x * cos + y * sin;
    for (let mark = Math.ceil((way - 0.55) * 5) / 5; mark < way + 0.55; mark += 0.2) {
      const u = SIDE / 2 + SCALE * (mark - way);
      stroke([[u, GROUND + 6], [u, GROUND + 12]], "#8c959f", 1);
    }
    robot(frame, side, false);
    ink.restore();
    ink.save(); ink.beginPath(); ink.rect(SIDE, 0, canvas.width - SIDE, HIGH); ink.clip();
    const middle = SIDE + (canvas.width - SIDE) / 2, near = 260;
    const top = p => [middle + near * (p[0] - x), HIGH / 2 - near * (p[1] - y)];
    for (let i = -2; i <= 2; i++) {
      const gx = (Math.round(x / 0.5) + i) * 0.5, gy = (Math.round(y / 0.5) + i) * 0.5;
      stroke([top([gx, y - 2]), top([gx, y + 2])], "#eaeef2", 1);
      stroke([top([x - 2, gy]), top([x + 2, gy])], "#eaeef2", 1);
    }
    stroke(frames.slice(0, number + 1).map(f => top([f[1], f[2]])), "#8c959f", 1.5);
    robot(frame, top, true);
    ink.restore();
    stroke([[SIDE, 0], [SIDE, HIGH]], "#e1e4e8", 1);
    ink.fillStyle = "#57606a"; ink.font = "14px system-ui, sans-serif";
    ink.fillText("from the right", 12, 22); ink.fillText("from above", SIDE + 12, 22);
    text.textContent = t.toFixed(2) + " s · height " + (z - floor).toFixed(3) + " m · pitch " +
      (frame[23] * 180 / Math.PI).toFixed(1) + "° · " + frame[22].toFixed(2) + " m/s";
    slider.value = String(Math.round(1000 * now / end));
  };
  const tick = at => {
    if (!playing) return;
    now += Math.min(0.1, (at - before) / 1000) * Number(speed.value);
    before = at;
    if (now >= end) { now = end; playing = false; button.textContent = "play"; }
    draw();
    requestAnimationFrame(tick);
  };
  button.onclick = () => {
    playing = !playing;
    if (playing && now >= end) now = 0;
    button.textContent = playing ? "pause" : "play";
    before = performance.now();
    requestAnimationFrame(tick);
  };
  slider.oninput = () => { now = end * Number(slider.value) / 1000; draw(); };
  draw();
})();
