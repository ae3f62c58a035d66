// Plays an exact motion and an engine's beside each other. All that it shows stands in the page.
(() => {
  const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
  const LEAST = 9; // px, radius of the smallest body: smaller ones are drawn larger than they are
  const STILLS = 12; // of a run, for those who want no motion

  const floats = (text) => new Float32Array(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);

  /** Turns a vector by a unit quaternion (w, x, y, z). */
  const turned = ([w, x, y, z], [a, b, c]) => {
    const p = 2 * (y * c - z * b), q = 2 * (z * a - x * c), r = 2 * (x * b - y * a);
    return [a + w * p + y * r - z * q, b + w * q + z * p - x * r, c + w * r + x * q - y * p];
  };

  /** Looks from a corner, from above. */
  const seen = ([x, y, z]) => [0.8 * x + 0.6 * y, 0.5 * (0.6 * x - 0.8 * y) - 0.866 * z];

  for (const figure of document.querySelectorAll("figure.beside")) {
    const told = JSON.parse(figure.querySelector("script").textContent);
    const [play, slider, choice] = ["button", "input", "select"].map((tag) => figure.querySelector(tag));
    const [canvas, said] = ["canvas", "output"].map((tag) => figure.querySelector(tag));
    const pen = canvas.getContext("2d");
    const exact = floats(told.exact), runs = told.runs.map((run) => floats(run.path));
    const bodies = told.bodies.length, last = told.frames - 1;
    const pace = Math.max(told.duration, 4) / last; // s of the clock for a frame
    const at = (path, k, i) => path.subarray(7 * (k * bodies + i), 7 * (k * bodies + i) + 7);
    let playing = 0, begun = 0;

    // The picture holds the exact motion, and of an engine's what is not farther off than half as much again.
    const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
    for (let k = 0; k <= last; k += 1)
      for (let i = 0; i < bodies; i += 1) {
        const reach = told.bodies[i].reach;
        seen(at(exact, k, i)).forEach((v, j) => {
          low[j] = Math.min(low[j], v - reach);
          high[j] = Math.max(high[j], v + reach);
        });
      }
    const middle = low.map((v, j) => (v + high[j]) / 2);
    const span = low.map((v, j) => 1.5 * (high[j] - v));

    const draw = () => {
      const k = Number(slider.value), name = choice.options[choice.selectedIndex].text;
      const ratio = devicePixelRatio || 1, wide = canvas.clientWidth, half = wide / 2, tall = canvas.clientHeight;
      canvas.width = wide * ratio;
      canvas.height = tall * ratio;
      pen.setTransform(ratio, 0, 0, ratio, 0, 0);
      const head = 34, room = Math.max(tall - head, 1);
      const scale = Math.min(half / span[0], room / span[1]) * 0.95;
      const panels = [["Exact", exact, "#0072B2"], [name, runs[choice.selectedIndex], "#B84A00"]];
      panels.forEach(([title, path, colour], side) => {
        const place = (p) => {
          const [u, v] = seen(p);
          return [half * (side + 0.5) + (u - middle[0]) * scale, head + room / 2 + (v - middle[1]) * scale];
        };
        const line = (points, ink, width, dash = []) => {
          pen.beginPath();
          points.forEach((p, n) => pen[n ? "lineTo" : "moveTo"](...place(p)));
          pen.strokeStyle = ink;
          pen.lineWidth = width;
          pen.setLineDash(dash);
          pen.stroke();
        };
        pen.save();
        pen.beginPath();
        pen.rect(half * side + 2, 0, half - 4, tall);
        pen.clip();
        pen.fillStyle = colour;
        pen.font = "600 18px system-ui, sans-serif";
        pen.fillText(title, half * side + 10, 24, half - 20);
        told.ground.forEach((points) => line(points, "#c4c4c4", 1));
        const trail = (of, until, ink, dash) =>
          line(Array.from({ length: until + 1 }, (_, n) => at(of, n, 0)), ink, 2, dash);
        if (side) trail(exact, last, "#0072B2", [6, 5]);
        trail(path, k, colour);
        for (let i = 0; i < bodies; i += 1) {
          const { lines, reach } = told.bodies[i], [x, y, z, ...q] = at(path, k, i);
          const larger = Math.max(1, LEAST / (reach * scale));
          lines.forEach((points) =>
            line(points.map((p) => turned(q, p).map((v, j) => [x, y, z][j] + larger * v)), colour, 2)
          );
        }
        pen.restore();
      });
      pen.setLineDash([]);
      pen.strokeStyle = "#767676";
      pen.lineWidth = 1;
      pen.strokeRect(0.5, 0.5, wide - 1, tall - 1);
      pen.strokeRect(half, 0.5, 0.5, tall - 1);
      let apart = 0;
      for (let i = 0; i < bodies; i += 1) {
        const [p, q] = [at(exact, k, i), at(runs[choice.selectedIndex], k, i)];
        apart = Math.max(apart, Math.hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
      }
      const time = (k * told.duration) / last;
      said.textContent = `${time.toFixed(2)} s, ${(1e3 * apart).toPrecision(3)} mm apart`;
      slider.setAttribute("aria-valuetext", said.textContent);
    };

    const stop = () => {
      cancelAnimationFrame(playing);
      playing = 0;
      play.textContent = still ? "Next still" : "Play";
    };
    const tick = (now) => {
      const k = Math.min(last, Math.floor((now - begun) / 1e3 / pace));
      if (k !== Number(slider.value)) {
        slider.value = k;
        draw();
      }
      if (k < last) playing = requestAnimationFrame(tick);
      else stop();
    };
    play.addEventListener("click", () => {
      if (playing) return stop();
      const from = Number(slider.value) >= last ? 0 : Number(slider.value);
      if (still) {
        slider.value = Number(slider.value) >= last ? 0 : Math.min(last, from + Math.ceil(last / STILLS));
        return draw();
      }
      begun = performance.now() - from * pace * 1e3;
      play.textContent = "Pause";
      playing = requestAnimationFrame(tick);
    });
    slider.addEventListener("input", () => { stop(); draw(); });
    choice.addEventListener("change", draw);
    addEventListener("resize", draw);
    addEventListener("beforeprint", draw);
    stop();
    figure.hidden = false;
    draw();
  }
})();
