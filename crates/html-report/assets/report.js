"use strict";
(() => {
  /** Numbers of four letters each: the leading 24 bits of an IEEE 754 single in base 64, NaN for what is absent. */
  const unpack = (text) => {
    const letter = (i) => {
      const c = text.charCodeAt(i);
      return c > 96 ? c - 71 : c > 64 ? c - 65 : c > 47 ? c + 4 : c === 43 ? 62 : 63;
    };
    const word = new DataView(new ArrayBuffer(4));
    return Array.from({ length: text.length / 4 }, (_, k) => {
      const bits = (letter(4 * k) << 18) | (letter(4 * k + 1) << 12) | (letter(4 * k + 2) << 6) | letter(4 * k + 3);
      word.setUint32(0, bits << 8);
      const value = word.getFloat32(0);
      return isNaN(value) ? null : +value.toPrecision(5);
    });
  };
  const studies = JSON.parse(document.getElementById("data").textContent, (_, value) => (value && value.f24 !== undefined ? unpack(value.f24) : value));
  const root = document.documentElement;
  const prefersDark = matchMedia("(prefers-color-scheme: dark)");
  const css = (name) => getComputedStyle(root).getPropertyValue(name).trim();
  const colour = (index) => css(`--f${index % 8}`);
  // Filters beyond the eighth repeat a colour with another dash.
  const dash = (index) => [[], [8, 3], [2, 3]][Math.floor(index / 8) % 3];
  const font = "12px Helvetica Neue, Helvetica, Arial, Liberation Sans, sans-serif";

  // ---- numbers
  const superscript = (n) => String(n).replace(/[-0-9]/g, (c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[+c]));
  const short = (v) => {
    if (v === null || v === undefined || !isFinite(v)) return "–";
    const a = Math.abs(v);
    const text = a === 0 ? "0" : a >= 1e-3 && a < 1e3 ? v.toPrecision(3) : a >= 1e3 && a < 1e5 ? String(+v.toPrecision(3)) : v.toExponential(2);
    return text.replaceAll("-", "−");
  };
  /** Exponent, a multiple of three, that leaves numbers of this size between 1 and 1000. */
  const exponent = (size) => (size > 0 && (size >= 1e4 || size < 1e-1) ? 3 * Math.floor(Math.log10(size) / 3 + 1e-9) : 0);
  const unitOf = (unit, e) => (e ? `10${superscript(e)} ${unit}` : unit);
  const trimmed = (v) => String(+v.toPrecision(6)).replace("-", "−");
  const power = (v) => {
    const e = Math.log10(v);
    return Math.abs(e - Math.round(e)) < 1e-9 ? (Math.abs(e) < 3.5 ? trimmed(v) : `10${superscript(Math.round(e))}`) : "";
  };

  // ---- small pieces of the page
  const element = (name, attributes = {}, text = "") => {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.textContent = text;
    return made;
  };
  const button = (text, action) => {
    const made = element("button", { type: "button" }, text);
    made.addEventListener("click", () => action(made));
    return made;
  };
  const tabs = (into, names, chosen, action) => {
    const list = element("span", { role: "tablist" });
    const all = names.map((name, index) => {
      const tab = button(name, () => {
        all.forEach((other) => other.setAttribute("aria-selected", String(other === tab)));
        action(index);
      });
      tab.setAttribute("role", "tab");
      tab.setAttribute("aria-selected", String(index === chosen));
      list.append(tab, " ");
      return tab;
    });
    into.append(list);
  };
  const toggle = (into, name, shown, tint, action) => {
    const made = button("", () => {
      const now = made.getAttribute("aria-pressed") !== "true";
      made.setAttribute("aria-pressed", String(now));
      action(now);
    });
    made.setAttribute("aria-pressed", String(shown));
    const key = element("i", { class: "key" });
    key.dataset.tint = tint;
    made.append(key, name);
    into.append(made);
  };
  const save = (name, type, text) => {
    const link = element("a", { download: name, href: URL.createObjectURL(new Blob([text], { type })) });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  };
  const csvText = (rows) => rows.map((row) => row.map((v) => {
    const text = v === null || v === undefined ? "" : String(v);
    return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  }).join(",")).join("\n") + "\n";
  const exports = (into, name, rows, svg) => {
    into.append(element("span", { class: "gap" }));
    const all = [button("CSV", () => save(`${name}.csv`, "text/csv", csvText(rows())))];
    if (svg) all.push(button("SVG", () => save(`${name}.svg`, "image/svg+xml", svg())));
    all.forEach((one) => one.classList.add("export"));
    into.append(...all);
  };

  // ---- SVG
  const escaped = (text) => String(text).replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);
  const tag = (name, attributes, inner = "") =>
    `<${name}${Object.entries(attributes).map(([k, v]) => ` ${k}="${escaped(v)}"`).join("")}>${inner}</${name}>`;
  const label = (x, y, text, more = {}) => tag("text", { x: x.toFixed(1), y: y.toFixed(1), fill: css("--ink"), ...more }, escaped(text));
  const picture = (width, height, inner, more = {}) =>
    tag("svg", { xmlns: "http://www.w3.org/2000/svg", viewBox: `0 0 ${width} ${height}`, width, height, role: "img", ...more,
      "font-family": "Helvetica Neue, Helvetica, Arial, Liberation Sans, sans-serif", "font-size": 12 }, inner);
  const ticks = (low, high, count) => {
    const raw = (high - low) / count;
    const size = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].map((m) => m * size).find((s) => s >= raw) ?? raw;
    const found = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1) found.push(k * step);
    return found;
  };
  /** Places of a logarithmic axis: powers of ten, or more between them where there are few. */
  const decades = (low, high, most = 20) => {
    const found = [];
    const span = Math.log10(high / low), every = Math.ceil(span / most);
    const within = span > 2.5 ? [1] : span > 0.9 ? [1, 2, 5] : span > 0.35 ? [1, 1.5, 2, 3, 4, 5, 7] :
      [1, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.8, 2, 2.2, 2.5, 3, 3.5, 4, 4.5, 5, 6, 7, 8, 9];
    for (let e = Math.floor(Math.log10(low) / every) * every; e <= Math.log10(high); e += every) {
      for (const m of within) found.push(+`${m}e${e}`);
    }
    return found.filter((v) => v >= low * (1 - 1e-9) && v <= high * (1 + 1e-9));
  };

  /**
   * One panel of lines, drawn at an offset.
   * series: {x, y, tint, width, dash, step}; x and y: {low, high, log, label}; shades: {from, to, tint}; bands: {low, high, tint}.
   */
  const panel = (o) => {
    const left = 62, bottom = 40, top = 22, right = 12;
    const w = o.width - left - right, h = o.height - top - bottom;
    const scale = (axis, v) => (axis.log ? Math.log(v / axis.low) / Math.log(axis.high / axis.low) : (v - axis.low) / (axis.high - axis.low));
    const px = (v) => left + w * scale(o.x, v);
    const py = (v) => top + h * (1 - scale(o.y, v));
    const clip = `clip${Math.random().toString(36).slice(2)}`;
    const inside = [];
    for (const s of o.shades ?? []) inside.push(tag("rect", { x: px(s.from), width: Math.max(px(s.to) - px(s.from), 1), y: top, height: h, fill: s.tint }));
    for (const b of o.bands ?? []) inside.push(tag("rect", { x: left, width: w, y: py(b.high), height: Math.max(py(b.low) - py(b.high), 1), fill: b.tint }));
    const frame = [];
    const e = o.y.log ? 0 : exponent(Math.max(Math.abs(o.y.low), Math.abs(o.y.high)));
    const ex = o.x.log ? 0 : exponent(Math.max(Math.abs(o.x.low), Math.abs(o.x.high)));
    for (const v of o.y.log ? decades(o.y.low, o.y.high) : ticks(o.y.low, o.y.high, 5)) {
      frame.push(tag("line", { x1: left, x2: left + w, y1: py(v), y2: py(v), stroke: css("--grid") }));
      frame.push(label(left - 6, py(v) + 4, o.y.log ? power(v) || trimmed(v) : trimmed(v / 10 ** e), { "text-anchor": "end" }));
    }
    for (const v of o.x.log ? decades(o.x.low, o.x.high, w / 44) : ticks(o.x.low, o.x.high, Math.min(10, Math.max(3, Math.floor(w / 65))))) {
      frame.push(tag("line", { x1: px(v), x2: px(v), y1: top, y2: top + h, stroke: css("--grid") }));
      frame.push(label(px(v), top + h + 16, o.x.log ? power(v) || trimmed(v) : trimmed(v / 10 ** ex), { "text-anchor": "middle" }));
    }
    for (const d of o.dots ?? []) {
      inside.push(tag("circle", { cx: px(d.x), cy: py(d.y), r: d.r ?? 4.5, fill: d.ring ? css("--paper") : d.tint, stroke: d.tint, "stroke-width": 1.5 }));
    }
    for (const s of o.series) {
      let path = "", open = false, last = 0;
      s.x.forEach((x, i) => {
        const y = s.y[i];
        if (y === null || y === undefined || x === null || (o.y.log && y <= 0) || (o.x.log && x <= 0)) return;
        const at = py(y);
        path += !open ? `M${px(x).toFixed(1)} ${at.toFixed(1)}` : s.step ? `H${px(x).toFixed(1)}V${at.toFixed(1)}` : `L${px(x).toFixed(1)} ${at.toFixed(1)}`;
        open = true;
        last = at;
      });
      if (open) inside.push(tag("path", { d: s.step ? `${path}H${left + w}` : path, fill: "none", stroke: s.tint, "stroke-width": s.width ?? 1.3, "stroke-dasharray": (s.dash ?? []).join(" ") || "none", "data-last": last.toFixed(1) }));
    }
    const named = (axis, factor) => axis.label + (axis.unit ? ` [${unitOf(axis.unit, factor)}]` : "");
    return tag("g", { transform: `translate(${o.left ?? 0} ${o.top ?? 0})` },
      tag("clipPath", { id: clip }, tag("rect", { x: left, y: top, width: w, height: h })) + frame.join("") +
      tag("g", { "clip-path": `url(#${clip})` }, inside.join("")) +
      tag("path", { d: `M${left} ${top}V${top + h}H${left + w}`, fill: "none", stroke: css("--ink") }) +
      label(left, 14, o.title ?? "", { "font-weight": 600 }) +
      label(left + w / 2, o.height - 6, named(o.x, ex), { "text-anchor": "middle" }) +
      label(14, top + h / 2, named(o.y, e), { "text-anchor": "middle", transform: `rotate(-90 14 ${top + h / 2})` }));
  };
  const key = (entries, width) => {
    let x = 62, y = 12;
    const inner = entries.map((entry) => {
      const length = 44 + 6.6 * entry.name.length;
      if (x + length > width) [x, y] = [62, y + 18];
      const made = tag("line", { x1: x, x2: x + 22, y1: y, y2: y, stroke: entry.tint, "stroke-width": 2, "stroke-dasharray": (entry.dash ?? []).join(" ") || "none" }) + label(x + 28, y + 4, entry.name);
      x += length;
      return made;
    });
    return { inner: inner.join(""), height: y + 12 };
  };

  // ---- plots over time
  let made = [];
  const extent = (arrays, keep) => {
    let low = Infinity, high = -Infinity;
    for (const array of arrays) array.forEach((v, i) => {
      if (v !== null && v !== undefined && isFinite(v) && keep(i)) { low = Math.min(low, v); high = Math.max(high, v); }
    });
    return low <= high ? [low, high] : null;
  };
  const padded = ([low, high], log) => {
    if (log) {
      const room = (high / low) ** 0.06 * 1.02;
      return [low / room, high * room];
    }
    const pad = 0.06 * (high - low) || Math.abs(high) || 1;
    return [low - pad, high + pad];
  };

  /** A plot whose time is zoomed together with all others of its group. */
  const timePlot = (into, o) => {
    const holder = element("div");
    into.append(holder);
    const range = o.range ?? [o.log ? 0.1 : -1, 1];
    const whole = [o.data[0][0], o.data[0][o.data[0].length - 1]];
    // Before the first drawing the scale of time is not known.
    const isWhole = (u) => (u.scales.x.min ?? null) === null || (u.scales.x.min <= whole[0] && u.scales.x.max >= whole[1]);
    let factor = exponent(Math.max(...range.map(Math.abs)));
    const axis = { stroke: css("--ink"), font, labelFont: font, labelSize: 20, labelGap: 0, grid: { stroke: css("--grid"), width: 1 }, ticks: { stroke: css("--rule"), size: 4, width: 1 } };
    const shade = (u) => {
      const { left, top, width, height } = u.bbox;
      const ctx = u.ctx;
      ctx.save();
      ctx.beginPath();
      ctx.rect(left, top, width, height);
      ctx.clip();
      for (const e of o.study.events) {
        const from = u.valToPos(e.from_s, "x", true), to = u.valToPos(e.to_s, "x", true);
        ctx.fillStyle = css(e.kind === "burn" ? "--burn" : "--vent");
        ctx.fillRect(from, top, Math.max(to - from, devicePixelRatio), height);
      }
      const bounds = o.bounds?.(u);
      if (bounds) {
        const low = u.valToPos(bounds[0], "y", true), high = u.valToPos(bounds[1], "y", true);
        ctx.fillStyle = css("--band");
        ctx.fillRect(left, high, width, Math.max(low - high, 2 * devicePixelRatio));
      }
      if (o.faint) {
        const { t, values } = o.faint;
        ctx.strokeStyle = css("--run");
        ctx.lineWidth = 0.6 * devicePixelRatio;
        const x = t.map((at) => u.valToPos(at, "x", true));
        ctx.beginPath();
        for (let begin = 0; begin < values.length; begin += t.length) {
          let open = false;
          for (let i = 0; i < t.length; i += 1) {
            const value = values[begin + i];
            if (value === null) continue;
            const y = u.valToPos(value, "y", true);
            if (open) ctx.lineTo(x[i], y);
            else ctx.moveTo(x[i], y);
            open = true;
          }
        }
        ctx.stroke();
      }
      ctx.restore();
    };
    const u = new uPlot({
      width: Math.max(holder.clientWidth, 200), height: o.height, title: "", legend: { show: false }, padding: [8, 8, 0, 0],
      cursor: { y: false, sync: { key: o.study.id, setSeries: false, scales: ["x", null] }, drag: { x: true, y: false }, points: { size: 5 } },
      scales: {
        x: { time: false },
        y: { distr: o.log ? 3 : 1, range: (self, low, high) => {
          const chosen = isWhole(self) || low === null || high === null ? range : padded([low, high], o.log);
          factor = exponent(Math.max(...chosen.map(Math.abs)));
          return chosen;
        } },
      },
      axes: [
        { ...axis, label: o.last ? "time [s]" : undefined, size: 30, space: 50, values: (self, all) => all.map(trimmed) },
        { ...axis, size: 46, label: () => `${o.label} [${o.log ? o.unit : unitOf(o.unit, factor)}]`,
          ...(o.log ? { splits: (self) => decades(self.scales.y.min, self.scales.y.max), filter: (self, all) => all } : {}),
          values: (self, all) => all.map((v) => (o.log ? power(v) || trimmed(v) : trimmed(v / 10 ** factor))) },
      ],
      series: [{}, ...o.series.map((s) => ({ label: s.name, stroke: css(s.tint) || s.tint, width: s.width ?? 1.25, dash: s.dash, show: s.show ?? true, spanGaps: true, points: { show: false } }))],
      // The time shown, for scripts that drive the page.
      hooks: { setScale: [(self, scale) => { if (scale === "x") { [holder.dataset.from, holder.dataset.to] = [self.scales.x.min, self.scales.x.max]; o.study.shown?.(isWhole(self) ? null : [self.scales.x.min, self.scales.x.max]); } }], drawAxes: [shade], setCursor: [(self) => self.cursor.event && o.hover(self)] },
    }, o.data, holder);
    made.push({ u, holder });
    return u;
  };
  const resize = () => made.forEach(({ u, holder }) => {
    if (holder.isConnected && Math.abs(holder.clientWidth - u.width) > 2) u.setSize({ width: Math.max(holder.clientWidth, 200), height: u.height });
  });

  /** Gives new plots the time that was shown before. */
  const rezoom = (live, zoom) => {
    const time = live[0]?.data[0];
    if (zoom && (zoom.min > time[0] || zoom.max < time[time.length - 1])) live.forEach((u) => u.setScale("x", { min: zoom.min, max: zoom.max }));
  };
  const forget = (live) => {
    live.forEach((u) => u.destroy());
    made = made.filter(({ u }) => !live.includes(u));
  };

  // ---- the figures of one study; each returns what draws it anew
  const shadesOf = (study) => study.events.map((e) => ({ from: e.from_s, to: e.to_s, tint: css(e.kind === "burn" ? "--burn" : "--vent") }));
  const LINES = [
    { name: "mean error", tint: "--f6", width: 1, of: [["mean", 1]] },
    { name: "3σ sample", tint: "--f0", of: [["sample", 3], ["sample", -3]] },
    { name: "3σ estimated", tint: "--f1", dash: [6, 3], of: [["estimated", 3], ["estimated", -3]] },
    { name: "single runs", tint: "--run", width: 0.6, of: [] },
  ];

  const RUNS = 3;

  const errors = (figure, study) => {
    const plots = figure.querySelector(".plots"), tools = figure.querySelector(".tools"), readout = figure.querySelector(".readout");
    const filters = study.filters.filter((f) => f.series);
    let chosen = 0;
    const shown = LINES.map(() => true);
    let live = [];
    const panels = () => {
      const { t, quantities } = filters[chosen].series;
      return quantities.flatMap((q) => q.axes.map((a) => {
        const lines = LINES.flatMap((line, index) => line.of.map(([kind, factor]) => ({ ...line, index, y: a[kind].map((v) => (v === null ? null : factor * v)) })));
        const kept = filters[chosen].kept, values = kept?.columns[a.column];
        return { t, title: `${q.name}, ${a.axis}`, unit: q.unit, lines, faint: values && { t: kept.t, values } };
      }));
    };
    const range = (p) => {
      const arrays = p.lines.filter((l) => shown[l.index]).map((l) => l.y);
      const lines = extent(arrays, (i) => p.t[i] >= study.scored_from_s) ?? extent(arrays, () => true);
      const runs = p.faint && shown[RUNS] && extent([p.faint.values], (i) => p.faint.t[i % p.faint.t.length] >= study.scored_from_s);
      if (!runs || !lines) return padded(lines ?? runs ?? [-1, 1]);
      // One run that is lost shall not flatten all others.
      return padded([Math.max(Math.min(lines[0], runs[0]), 1.6 * Math.min(lines[0], 0)), Math.min(Math.max(lines[1], runs[1]), 1.6 * Math.max(lines[1], 0))]);
    };
    const draw = () => {
      const zoom = live[0]?.scales.x;
      forget(live);
      plots.replaceChildren();
      figure.querySelector(".chosen").textContent = filters[chosen].name;
      const all = panels();
      live = all.map((p, index) => timePlot(plots, {
        study, data: [p.t, ...p.lines.map((l) => l.y)], range: range(p), label: p.title, unit: p.unit, height: 200,
        faint: shown[RUNS] ? p.faint : null, last: index >= all.length - 3 || innerWidth <= 720,
        series: p.lines.map((l) => ({ name: l.name, tint: l.tint, width: l.width, dash: l.dash, show: shown[l.index] })),
        hover: (u) => {
          const i = u.cursor.idx;
          if (i === null || i === undefined) return;
          const of = (line) => short(Math.abs(p.lines.find((l) => l.index === line).y[i] ?? NaN));
          readout.textContent = `${filters[chosen].name}, t = ${trimmed(p.t[i])} s, ${p.title}: mean error ${short(p.lines[0].y[i])} ${p.unit}, 3σ sample ${of(1)} ${p.unit}, 3σ estimated ${of(2)} ${p.unit}`;
        },
      }));
      rezoom(live, zoom);
    };
    if (filters.length === 0) return () => {};
    tabs(tools, filters.map((f) => f.name), 0, (index) => { chosen = index; draw(); });
    LINES.filter((_, index) => index !== RUNS || filters.some((f) => f.kept)).forEach((line, index) => toggle(tools, line.name, true, line.tint, (on) => { shown[index] = on; draw(); }));
    exports(tools, `${study.scenario}_error`, () => {
      const all = panels();
      const head = all.flatMap((p) => ["mean", "3 sigma sample", "3 sigma estimated"].map((n) => `${n} ${p.title} [${p.unit}]`));
      return [["filter", "time [s]", ...head], ...all[0].t.map((t, i) => [filters[chosen].name, t, ...all.flatMap((p) => [0, 1, 3].map((l) => p.lines[l].y[i]))])];
    }, () => {
      const all = panels(), width = 380, height = 230;
      const legend = key([{ name: filters[chosen].name, tint: "none" }, ...LINES.filter((_, i) => shown[i]).map((l) => ({ ...l, tint: css(l.tint) }))], 3 * width);
      const x = live[0].scales.x;
      const inner = all.map((p, i) => {
        const [low, high] = [live[i].scales.y.min, live[i].scales.y.max];
        return panel({ width, height, left: (i % 3) * width, top: legend.height + Math.floor(i / 3) * height, title: p.title,
          x: { low: x.min, high: x.max, label: "time", unit: "s" }, y: { low, high, label: "error", unit: p.unit },
          shades: shadesOf(study),
          series: [...(p.faint && shown[RUNS] ? Array.from({ length: p.faint.values.length / p.faint.t.length }, (_, k) => ({
            x: p.faint.t, y: p.faint.values.slice(k * p.faint.t.length, (k + 1) * p.faint.t.length), tint: css("--run"), width: 0.6 })) : []),
          ...p.lines.filter((l) => shown[l.index]).map((l) => ({ x: p.t, y: l.y, tint: css(l.tint), width: l.width, dash: l.dash }))] });
      });
      return picture(3 * width, legend.height + Math.ceil(all.length / 3) * height, legend.inner + inner.join(""));
    });
    return draw;
  };

  const timesOf = (filters) => [...new Set(filters.flatMap((f) => f.series.t))].sort((a, b) => a - b);
  const aligned = (times, f, values) => {
    if (f.series.t.length === times.length) return values;
    const at = new Map(f.series.t.map((t, i) => [t, values[i]]));
    return times.map((t) => at.get(t) ?? null);
  };

  const noise = (figure, study) => {
    const plots = figure.querySelector(".plots"), tools = figure.querySelector(".tools"), readout = figure.querySelector(".readout");
    const filters = study.filters.map((f, index) => ({ ...f, index })).filter((f) => f.series?.jerk_root);
    const shown = filters.map(() => true);
    const times = timesOf(filters);
    const names = ["x", "y", "z"], unit = "m/s²·⁵";
    const data = names.map((_, axis) => filters.map((f) => aligned(times, f, f.series.jerk_root[axis]).map((v) => (v > 0 ? v : null))));
    const range = (axis) => padded(extent(data[axis].filter((_, i) => shown[i]), (i) => times[i] >= study.scored_from_s) ?? [0.1, 10], true);
    let live = [];
    const draw = () => {
      const zoom = live[0]?.scales.x;
      forget(live);
      plots.replaceChildren();
      live = names.map((name, axis) => timePlot(plots, {
        study, data: [times, ...data[axis]], range: range(axis), log: true, label: `√q, ${name}`, unit, height: 230, last: true,
        series: filters.map((f, i) => ({ name: f.name, tint: colour(f.index), dash: dash(f.index), width: 1.2, show: shown[i] })),
        hover: (u) => {
          const i = u.cursor.idx;
          if (i === null || i === undefined) return;
          readout.textContent = `t = ${trimmed(times[i])} s, √q, ${name} [${unit}]: ` + filters.flatMap((f, k) => (shown[k] ? [`${f.name} ${short(data[axis][k][i])}`] : [])).join(", ");
        },
      }));
      rezoom(live, zoom);
    };
    filters.forEach((f, i) => toggle(tools, f.name, true, `--f${f.index % 8}`, (on) => { shown[i] = on; draw(); }));
    exports(tools, `${study.scenario}_process_noise`,
      () => [["time [s]", ...names.flatMap((name) => filters.map((f) => `root of q ${name} ${f.name} [m/s^2.5]`))], ...times.map((t, i) => [t, ...data.flatMap((axis) => axis.map((d) => d[i]))])],
      () => {
        const width = 380, height = 280;
        const legend = key(filters.filter((f, i) => shown[i]).map((f) => ({ name: f.name, tint: colour(f.index), dash: dash(f.index) })), 3 * width);
        return picture(3 * width, legend.height + height, legend.inner + names.map((name, axis) => {
          const { x, y } = live[axis].scales;
          return panel({ width, height, left: axis * width, top: legend.height, x: { low: x.min, high: x.max, label: "time", unit: "s" }, y: { low: y.min, high: y.max, log: true, label: `√q, ${name}`, unit }, shades: shadesOf(study),
            series: filters.map((f, i) => ({ x: times, y: data[axis][i], tint: colour(f.index), dash: dash(f.index) })).filter((_, i) => shown[i]) });
        }).join(""));
      });
    return draw;
  };

  /** Errors of the time that is shown, from sums over all epochs. */
  const windowed = (figure, study) => {
    const body = figure.querySelector("tbody");
    const filters = study.filters.filter((f) => f.window);
    const resort = sortable(figure, study, `${study.scenario}_time`);
    const fill = (time) => {
      const [low, high] = time ?? [study.scored_from_s, Infinity];
      let span = null;
      body.replaceChildren(...filters.map((f) => {
        const w = f.window;
        const inside = w.from.map((from, i) => (from >= low && w.to[i] <= high ? i : -1)).filter((i) => i >= 0);
        if (inside.length) span = [w.from[inside[0]], w.to[inside[inside.length - 1]]];
        const mean = (s) => {
          const total = (list) => inside.reduce((sum, i) => sum + (list[i] ?? 0), 0);
          const weight = total(s.weight);
          return weight > 0 ? total(s.sum) / weight : null;
        };
        const root = (v) => (v === null ? null : Math.sqrt(v));
        const row = element("tr");
        row.append(element("th", { scope: "row" }, f.name), ...[...w.squares.map((s) => root(mean(s))), mean(w.nees), mean(w.nis)].map((v) => element("td", { "data-value": v ?? "" }, short(v))));
        return row;
      }));
      figure.querySelector(".span").textContent = span ? `${trimmed(span[0])} to ${trimmed(span[1])} s${time ? "" : ", the scored time"}` : "no whole stretch of it is in the choice";
      resort();
    };
    let waiting = 0;
    study.shown = (time) => { clearTimeout(waiting); waiting = setTimeout(() => fill(time), 30); };
    fill(null);
    return () => {};
  };

  const path = (figure, study) => {
    const plots = figure.querySelector(".plots"), tools = figure.querySelector(".tools");
    const { t, axes, relative, chaser, body } = study.path;
    const [a, b, c] = axes;
    const views = [[relative, 1, 0, b, a, "relative path"], [relative, 1, 2, b, c, "relative path"]];
    if (chaser.length) views.push([chaser.map((list, i) => list.map((v) => (v === null ? null : v - body[1][i]))), 0, 2, "x", "z", `orbit about the ${body[0]}`]);
    if (chaser.length) views.push([views[2][0], 1, 2, "y", "z", `orbit about the ${body[0]}`]);
    const svg = (fixed) => {
      const full = fixed || Math.max(330, Math.min(plots.clientWidth || 900, 1000)), across = full > 600 ? 2 : 1;
      const width = full / across, height = Math.min(0.85 * width, 380);
      let unequal = false;
      const inner = views.map(([list, i, j, first, second, title], k) => {
        const orbit = list !== relative;
        const x = list[i], y = list[j];
        const range = (values) => padded(extent([orbit ? [...values, 0] : values], () => true) ?? [-1, 1]);
        let [x0, x1] = range(x), [y0, y1] = range(y);
        // The same metres both ways, where that leaves something to see.
        const w = width - 74, h = height - 62, ratio = ((x1 - x0) / w) / ((y1 - y0) / h);
        if (ratio > 1 && ratio < 6) [y0, y1] = [(y0 + y1) / 2 - ratio * (y1 - y0) / 2, (y0 + y1) / 2 + ratio * (y1 - y0) / 2];
        else if (ratio <= 1 && ratio > 1 / 6) [x0, x1] = [(x0 + x1) / 2 - (x1 - x0) / ratio / 2, (x0 + x1) / 2 + (x1 - x0) / ratio / 2];
        else unequal = true;
        const during = (e) => ({ x: x.map((v, n) => (t[n] >= e.from_s && t[n] <= e.to_s ? v : null)), y, tint: css(e.kind === "burn" ? "--f4" : "--f5"), width: 5 });
        // What is shorter than the time between points has one of them.
        const near = (e) => t.reduce((best, at, n) => (Math.abs(at - e.from_s) < Math.abs(t[best] - e.from_s) ? n : best), 0);
        const marks = orbit ? [] : study.events.map(during);
        const burns = orbit ? [] : study.events.filter((e) => e.kind === "burn").map((e) => ({ x: x[near(e)], y: y[near(e)], tint: css("--f4"), r: 7 }));
        const last = t.length - 1;
        const dots = [{ x: x[0], y: y[0], tint: css("--ink"), ring: true }, ...burns, { x: x[last], y: y[last], tint: css("--ink") }];
        if (orbit) dots.push({ x: 0, y: 0, tint: css("--soft") });
        return panel({ width, height, left: (k % across) * width, top: Math.floor(k / across) * height, title: `${title}, ${first} and ${second}`,
          x: { low: x0, high: x1, label: first, unit: "m" }, y: { low: y0, high: y1, label: second, unit: "m" },
          series: [...marks, { x, y, tint: css("--ink"), width: 1.4 }], dots });
      });
      figure.querySelector(".axis-note").textContent = (unequal ? "Scales of the two axes differ where a path is long and thin." : "") + (chaser.length ? " Grey: the body; axes N." : "");
      return picture(full, Math.ceil(views.length / across) * height, inner.join(""));
    };
    exports(tools, `${study.scenario}_path`, () => [["time [s]", ...axes.map((axis) => `${axis} of chaser from target [m]`), ...(chaser.length ? ["chaser x [m]", "chaser y [m]", "chaser z [m]"] : [])],
      ...t.map((at, i) => [at, ...relative.map((l) => l[i]), ...chaser.map((l) => l[i])])], () => svg(900));
    return () => { plots.innerHTML = svg(0); };
  };

  /** Filters by phases or cases, the stronger the colour the larger beside the best of the phase or case. */
  const matrix = (kind) => (figure, study) => {
    const plots = figure.querySelector(".plots"), tools = figure.querySelector(".tools");
    const { of, rows, columns, values, shades, best } = study[kind];
    const svg = (fixed) => {
      const left = 14 + 6.4 * Math.max(...rows.map((r) => r.length)), line = 28;
      const room = fixed || Math.min(plots.clientWidth || 900, 1000);
      const cell = Math.max(Math.min((room - left) / columns.length, 150), 62);
      const slanted = columns.some((c) => 7 * c.length > cell - 8);
      const top = slanted ? 24 + 4.2 * Math.max(...columns.map((c) => c.length)) : 24;
      // What is slanted reaches beyond its column.
      const right = slanted ? Math.max(...columns.map((c, k) => 5.8 * c.length - (columns.length - k - 0.5) * cell), 0) : 0;
      const full = Math.max(room, left + cell * columns.length + right);
      const heads = columns.map((c, k) => {
        const x = left + (k + 0.5) * cell;
        return label(x, top - 8, c, slanted ? { transform: `rotate(-35 ${x.toFixed(1)} ${top - 8})` } : { "text-anchor": "middle" });
      });
      const lines = rows.map((name, r) => label(left - 8, top + (r + 0.5) * line + 4, name, { "text-anchor": "end" }) + columns.map((c, k) =>
        tag("g", {}, tag("title", {}, escaped(`${name}, ${c}: ${short(values[r][k])} m`)) +
          tag("rect", { x: left + k * cell + 1, y: top + r * line + 1, width: cell - 2, height: line - 2, fill: css("--heat"), "fill-opacity": (0.08 + 0.62 * shades[r][k]).toFixed(3) }) +
          label(left + (k + 0.5) * cell, top + (r + 0.5) * line + 4, short(values[r][k]), { "text-anchor": "middle", "font-weight": best[r][k] ? 700 : 400 }))).join(""));
      // Letters stay readable on a narrow screen, where the figure scrolls instead.
      return picture(full, top + line * rows.length + 4, heads.join("") + lines.join(""), { style: `min-width: ${(0.85 * full).toFixed(0)}px` });
    };
    exports(tools, `${study.scenario}_${kind}`, () => [[of, ...columns.map((c) => `${c} [m]`)], ...rows.map((name, r) => [name, ...values[r]])], () => svg(900));
    return () => { plots.innerHTML = svg(0); };
  };

  /** Candidates of a search, one panel for each parameter. */
  const search = (figure, study) => {
    const plots = figure.querySelector(".plots"), tools = figure.querySelector(".tools");
    let chosen = 0;
    const svg = (fixed) => {
      const s = study.search[chosen];
      const full = fixed || Math.max(330, Math.min(plots.clientWidth || 900, 1000));
      const across = Math.min(s.parameters.length, full > 600 ? 3 : 1), width = full / across, height = 270;
      const found = s.tries.filter((t) => t.error > 0);
      const errors = found.map((t) => t.error);
      const [low, high] = errors.length ? padded([Math.min(...errors), Math.max(...errors)], true) : [0.1, 1];
      const [best, given] = [s.best, s.given].map((index) => (index === null ? null : s.tries[index]));
      figure.querySelector(".chosen").textContent = s.filter;
      const panels = s.parameters.map((p, i) => {
        const twentieth = (p.high / p.low) ** 0.05, room = twentieth ** 0.6;
        return panel({ width, height, left: (i % across) * width, top: Math.floor(i / across) * height, title: p.name,
          x: { low: p.low / room, high: p.high * room, log: true, label: "value", unit: "" }, y: { low, high, log: true, label: `${s.objective[0]} RMSE`, unit: s.objective[1] },
          shades: [{ from: p.low, to: p.low * twentieth, tint: css("--burn") }, { from: p.high / twentieth, to: p.high, tint: css("--burn") }],
          series: given ? [{ x: [p.low / room, p.high * room], y: [given.error, given.error], tint: css("--soft"), width: 1, dash: [4, 3] }] : [],
          dots: found.filter((t) => t.values.length > i).map((t) => ({ x: t.values[i], y: t.error, tint: t.feasible ? css("--f0") : css("--soft"), ring: !t.feasible, r: t === best ? 6.5 : 3 })) });
      });
      return picture(full, Math.ceil(panels.length / across) * height, panels.join(""));
    };
    const draw = () => { plots.innerHTML = svg(0); };
    tabs(tools, study.search.map((s) => s.filter), 0, (index) => { chosen = index; draw(); });
    exports(tools, `${study.scenario}_search`, () => {
      const s = study.search[chosen];
      return [["filter", ...s.parameters.map((p) => p.name), `${s.objective[0]} RMSE [${s.objective[1]}]`, "feasible"], ...s.tries.map((t) => [s.filter, ...s.parameters.map((_, i) => t.values[i]), t.error, t.feasible ? 1 : 0])];
    }, () => svg(900));
    return draw;
  };

  const learning = (figure, study) => {
    const plots = figure.querySelector(".plots"), tools = figure.querySelector(".tools");
    const { t, span_s, axes } = study.learning;
    const lines = [{ name: "true acceleration", tint: "--f6" }, { name: "error of its estimate", tint: "--f1" }];
    const svg = (fixed) => {
      const full = fixed || Math.max(330, Math.min(plots.clientWidth || 900, 1000)), across = full > 600 ? 3 : 1, width = full / across, height = 270;
      const legend = key(lines.map((l) => ({ ...l, tint: css(l.tint) })), full);
      const inner = axes.map((axis, i) => panel({ width, height, left: (i % across) * width, top: legend.height + Math.floor(i / across) * height, title: `d, ${axis.name}`,
        x: { low: span_s[0], high: span_s[1], log: true, label: "time", unit: "s" }, y: { low: axis.range[0], high: axis.range[1], log: true, label: "acceleration", unit: "m/s²" },
        series: [axis.truth, axis.error].map((y, k) => ({ x: t, y, tint: css(lines[k].tint), width: 1.5 })) }));
      return picture(full, legend.height + Math.ceil(axes.length / across) * height, legend.inner + inner.join(""));
    };
    exports(tools, "learning_curve", () => [["time [s]", ...axes.flatMap((a) => [`size of d ${a.name} [m/s²]`, `error of d ${a.name} [m/s²]`])], ...t.map((at, i) => [at, ...axes.flatMap((a) => [a.truth[i], a.error[i]])])], () => svg(900));
    return () => { plots.innerHTML = svg(0); };
  };

  const consistency = (figure, study) => {
    const plots = figure.querySelector(".plots"), tools = figure.querySelector(".tools"), readout = figure.querySelector(".readout");
    const filters = study.filters.map((f, index) => ({ ...f, index })).filter((f) => f.series && f.series.nees.t.length + f.series.nis.t.length);
    if (filters.length === 0) return () => {};
    const shown = filters.map(() => true);
    let live = [];
    const kinds = [["nees", "NEES / states"], ["nis", "NIS / rows"]];
    const onTimes = (times, { t, mean }) => {
      const at = new Map(t.map((time, i) => [time, mean[i]]));
      return times.map((time) => { const v = at.get(time); return v > 0 ? v : null; });
    };
    const all = (of) => [...new Set(of.flatMap((kind) => filters.flatMap((f) => f.series[kind].t)))].sort((a, b) => a - b);
    const times = { nees: all(["nees"]), nis: all(["nis"]) };
    const data = Object.fromEntries(kinds.map(([kind]) => [kind, filters.map((f) => onTimes(times[kind], f.series[kind]))]));
    const bounds = (kind) => filters.find((f, i) => shown[i] && f[`${kind}_bounds`])?.[`${kind}_bounds`];
    const range = (kind) => {
      const from = Math.max(times[kind].findIndex((t) => t >= study.scored_from_s), 0);
      return padded(extent([...data[kind].filter((d, i) => shown[i]).map((d) => d.slice(from)), bounds(kind) ?? [1]], () => true) ?? [0.1, 10], true);
    };
    const draw = () => {
      const zoom = live[0]?.scales.x;
      forget(live);
      plots.replaceChildren();
      live = kinds.map(([kind, name], index) => timePlot(plots, {
        study, data: [times[kind], ...data[kind]], range: range(kind), log: true, label: name, unit: "1", height: 230,
        last: index === 1, bounds: () => bounds(kind),
        series: filters.map((f, i) => ({ name: f.name, tint: colour(f.index), dash: dash(f.index), width: 1.1, show: shown[i] })),
        hover: (u) => {
          const i = u.cursor.idx;
          if (i === null || i === undefined) return;
          readout.textContent = `t = ${trimmed(times[kind][i])} s, ${name}: ` + filters.filter((f, k) => shown[k]).map((f) => `${f.name} ${short(data[kind][filters.indexOf(f)][i])}`).join(", ");
        },
      }));
      rezoom(live, zoom);
    };
    filters.forEach((f, i) => toggle(tools, f.name, true, `--f${f.index % 8}`, (on) => { shown[i] = on; draw(); }));
    const csvRows = () => {
      const either = all(["nees", "nis"]);
      const columns = kinds.flatMap(([kind]) => filters.map((f) => onTimes(either, f.series[kind])));
      return either.map((t, i) => [t, ...columns.map((c) => c[i])]);
    };
    exports(tools, `${study.scenario}_consistency`,
      () => [["time [s]", ...kinds.flatMap(([kind]) => filters.map((f) => `${kind} ${f.name}`))], ...csvRows()],
      () => {
        const width = 900, height = 280;
        const legend = key(filters.filter((f, i) => shown[i]).map((f) => ({ name: f.name, tint: colour(f.index), dash: dash(f.index) })), width);
        const inner = kinds.map(([kind, name], k) => {
          const b = bounds(kind), { x, y } = live[k].scales;
          return panel({ width, height, top: legend.height + k * height, x: { low: x.min, high: x.max, label: "time", unit: "s" }, y: { low: y.min, high: y.max, log: true, label: name }, shades: shadesOf(study),
            bands: b ? [{ low: b[0], high: b[1], tint: css("--band") }] : [],
            series: filters.map((f, i) => ({ x: times[kind], y: data[kind][i], tint: colour(f.index), dash: dash(f.index) })).filter((s, i) => shown[i]) });
        });
        return picture(width, legend.height + 2 * height, legend.inner + inner.join(""));
      });
    return draw;
  };

  const forest = (figure, study) => {
    const plots = figure.querySelector(".plots"), tools = figure.querySelector(".tools");
    const quantities = study.errors.filter(([name]) => study.forest.some((f) => f.quantity === name));
    if (quantities.length === 0) {
      plots.textContent = "There is no pair of filters with results.";
      return () => {};
    }
    const references = study.filters.map((f) => f.name).filter((name) => study.forest.some((f) => f.reference === name || f.filter === name));
    const pairs = study.forest.some((f) => f.reference !== study.forest[0].reference);
    let chosen = 0, against = null;
    const turned = (f) => ({ ...f, filter: f.reference, reference: f.filter, mean: -f.mean, low: f.low === null ? null : -f.high, high: f.high === null ? null : -f.low });
    const rows = () => study.forest.filter((f) => f.quantity === quantities[chosen][0]).flatMap((f) =>
      (against === null || f.reference === against ? [f] : f.filter === against ? [turned(f)] : []));
    const pair = (f) => `${f.filter} − ${f.reference}`;
    const svg = () => {
      const all = rows(), unit = quantities[chosen][1];
      const width = Math.max(330, Math.min(plots.clientWidth || 900, 1000)), narrow = width <= 600, line = narrow ? 42 : 30, top = 14;
      const left = narrow ? 14 : Math.min(30 + 7 * Math.max(...all.map((f) => pair(f).length)), 0.42 * width), right = narrow ? 14 : 190;
      const height = top + line * all.length + 46;
      const ends = all.flatMap((f) => [f.low ?? f.mean, f.high ?? f.mean, f.mean]);
      const largest = Math.max(...ends.map(Math.abs)) || 1;
      // Differences of several orders of magnitude: linear about zero, logarithmic beyond.
      const within = study.linear_within[study.errors.findIndex((e) => e[0] === quantities[chosen][0])], wide = within !== null;
      const to = wide ? (v) => Math.asinh(v / within) : (v) => v;
      const low = Math.min(0, ...ends.map(to)), high = Math.max(0, ...ends.map(to));
      const pad = 0.05 * (high - low);
      const px = (v) => left + ((to(v) - low + pad) / (high - low + 2 * pad)) * (width - left - right);
      const e = wide ? 0 : exponent(largest);
      figure.querySelector(".chosen").textContent = quantities[chosen][0];
      figure.querySelector(".axis-note").textContent = wide ? "The axis is linear about zero and logarithmic beyond, since the differences span orders of magnitude." : "";
      let at = ticks(low - pad, high + pad, width > 600 ? 7 : 4);
      if (wide) {
        const candidates = [0];
        for (let k = Math.floor(Math.log10(2 * within)); k <= Math.log10(largest) + 0.5; k += 1) candidates.push(10 ** k, -(10 ** k));
        at = [];
        for (const v of candidates) {
          const x = px(v);
          if (x >= left && x <= width - right && at.every((other) => Math.abs(px(other) - x) > 44)) at.push(v);
        }
      }
      const name = (v) => (wide ? (v === 0 ? "0" : (v < 0 ? "−" : "") + (power(Math.abs(v)) || short(Math.abs(v)))) : trimmed(v / 10 ** e));
      const base = top + line * all.length;
      const grid = at.map((v) => tag("line", { x1: px(v), x2: px(v), y1: top, y2: base, stroke: css("--grid") }) + label(px(v), base + 16, name(v), { "text-anchor": "middle" }));
      const marks = all.map((f, i) => {
        const y = top + line * (i + (narrow ? 0.7 : 0.5)), index = study.filters.findIndex((o) => o.name === f.filter), tint = colour(index);
        const interval = f.low === null ? "" : tag("line", { x1: px(f.low), x2: px(f.high), y1: y, y2: y, stroke: tint, "stroke-width": 2 }) +
          [f.low, f.high].map((v) => tag("line", { x1: px(v), x2: px(v), y1: y - 5, y2: y + 5, stroke: tint, "stroke-width": 2 })).join("");
        const text = `${short(f.mean)}${f.low === null ? "" : ` (${short(f.low)}, ${short(f.high)})`}`;
        return tag("g", {}, tag("title", {}, escaped(`${pair(f)}: ${text} ${unit}, ${f.runs} runs`)) +
          tag("rect", { x: 0, y: y - line / 2, width, height: line, fill: "transparent" }) +
          label(narrow ? left : left - 12, narrow ? y - 14 : y + 4, pair(f), { "text-anchor": narrow ? "start" : "end" }) + interval +
          tag("circle", { cx: px(f.mean), cy: y, r: 4.5, fill: tint }) + (width > 600 ? label(width - right + 14, y + 4, text, { fill: css("--soft") }) : ""));
      });
      return picture(width, height, grid.join("") + tag("line", { x1: px(0), x2: px(0), y1: top, y2: base, stroke: css("--ink") }) + marks.join("") +
        tag("path", { d: `M${left} ${base}H${width - right}`, stroke: css("--ink") }) +
        label((left + width - right) / 2, base + 38, `difference of ${quantities[chosen][0]} RMSE [${unitOf(unit, e)}]`, { "text-anchor": "middle" }));
    };
    const draw = () => { plots.innerHTML = svg(); };
    tabs(tools, quantities.map(([name]) => name), 0, (index) => { chosen = index; draw(); });
    if (pairs) tabs(tools, ["every pair", ...references], 0, (index) => { against = index ? references[index - 1] : null; draw(); });
    exports(tools, `${study.scenario}_paired`, () => [["filter", "reference", "quantity", "unit", "runs", "mean difference", "low", "high"], ...rows().map((f) => [f.filter, f.reference, f.quantity, f.unit, f.runs, f.mean, f.low, f.high])], svg);
    return draw;
  };

  const cdf = (figure, study) => {
    const plots = figure.querySelector(".plots"), tools = figure.querySelector(".tools"), readout = figure.querySelector(".readout");
    const quantities = study.errors.map((e, index) => ({ name: e[0], unit: e[1], index })).filter((q) => study.filters.some((f) => f.sorted[q.index].length));
    if (quantities.length === 0) {
      plots.textContent = "There is no run with a result.";
      return () => {};
    }
    let chosen = 0;
    const shown = study.filters.map(() => true);
    const axis = () => {
      const q = quantities[chosen];
      const all = study.filters.filter((f, i) => shown[i]).flatMap((f) => f.sorted[q.index]).filter((v) => v > 0);
      const [low, high] = all.length ? [Math.min(...all), Math.max(...all)] : [0.1, 1];
      const log = high / low > 5;
      const [from, to] = padded([low, high], log);
      return { low: log ? from : Math.max(from, 0), high: to, log, label: `${q.name} RMSE of a run`, unit: q.unit };
    };
    const curve = (f) => {
      const values = f.sorted[quantities[chosen].index];
      return { x: [...(values.length ? [values[0]] : []), ...values], y: [0, ...values.map((v, i) => (i + 1) / f.runs)] };
    };
    const svg = (width) => {
      const legend = width ? key(study.filters.map((f, i) => ({ name: f.name, tint: colour(i), dash: dash(i) })).filter((f, i) => shown[i]), width) : { inner: "", height: 0 };
      const w = width || Math.max(330, Math.min(plots.clientWidth || 900, 1000));
      return picture(w, 330 + legend.height, legend.inner + panel({ width: w, height: 330, top: legend.height, x: axis(), y: { low: 0, high: 1.02, label: "share of runs", unit: "1" },
        series: study.filters.map((f, i) => ({ ...curve(f), tint: colour(i), dash: dash(i), width: 1.8, step: true })).filter((s, i) => shown[i]) }));
    };
    const draw = () => {
      plots.innerHTML = svg(0);
      figure.querySelector(".chosen").textContent = quantities[chosen].name;
    };
    plots.addEventListener("mousemove", (event) => {
      const picture = plots.firstElementChild, box = picture.getBoundingClientRect(), width = picture.viewBox.baseVal.width;
      const part = (((event.clientX - box.left) / box.width) * width - 62) / (width - 74);
      if (part < 0 || part > 1) return;
      const a = axis();
      const value = a.log ? a.low * (a.high / a.low) ** part : a.low + part * (a.high - a.low);
      readout.textContent = `${short(value)} ${a.unit} or less: ` + study.filters.filter((f, i) => shown[i]).map((f) => `${f.name} ${f.sorted[quantities[chosen].index].filter((v) => v <= value).length} of ${f.runs}`).join(", ");
    });
    tabs(tools, quantities.map((q) => q.name), 0, (index) => { chosen = index; draw(); });
    study.filters.forEach((f, i) => toggle(tools, f.name, true, `--f${i % 8}`, (on) => { shown[i] = on; draw(); }));
    exports(tools, `${study.scenario}_runs`, () => [["filter", `${quantities[chosen].name} RMSE [${quantities[chosen].unit}]`, "share of runs"], ...study.filters.filter((f, i) => shown[i]).flatMap((f) => f.sorted[quantities[chosen].index].map((v, i) => [f.name, v, (i + 1) / f.runs]))], () => svg(900));
    return draw;
  };

  const sortable = (figure, study, name) => {
    const table = figure.querySelector("table"), body = table.tBodies[0], heads = [...table.tHead.rows[0].cells];
    const sort = () => {
      const column = heads.findIndex((head) => head.hasAttribute("aria-sort"));
      if (column < 0) return;
      const ascending = heads[column].getAttribute("aria-sort") === "ascending";
      const value = (row) => row.cells[column].dataset.value ?? row.cells[column].textContent;
      const sign = ascending ? 1 : -1;
      body.append(...[...body.rows].sort((a, b) => {
        const [x, y] = [value(a), value(b)];
        // What is absent comes last, whichever way.
        if (x === "" || y === "") return (x === "") - (y === "");
        return sign * (isFinite(x) && isFinite(y) ? x - y : x.localeCompare(y));
      }));
    };
    heads.forEach((head) => head.querySelector("button").addEventListener("click", () => {
      const ascending = head.getAttribute("aria-sort") !== "ascending";
      heads.forEach((other) => other.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", ascending ? "ascending" : "descending");
      sort();
    }));
    exports(figure.querySelector(".tools"), name, () => [heads.map((h) => h.textContent), ...[...body.rows].map((row) => [...row.cells].map((c) => c.dataset.value ?? c.textContent))]);
    return sort;
  };

  // ---- all of it
  const draws = studies.flatMap((study) => {
    const article = document.getElementById(study.id);
    const figure = (name, make) => {
      const found = article.querySelector(`figure.${name}`);
      return found ? [make(found, study)] : [];
    };
    sortable(article.querySelector("figure.summary"), study, `${study.scenario}_summary`);
    return [...figure("learning", learning), ...figure("search", search), ...figure("cases", matrix("cases")), ...figure("phases", matrix("phases")), ...figure("window", windowed), ...figure("errors", errors), ...figure("noise", noise), ...figure("path", path), ...figure("consistency", consistency), ...figure("forest", forest), ...figure("cdf", cdf)];
  });
  const themeButton = document.getElementById("theme");
  const dress = (dark) => {
    root.dataset.theme = dark ? "dark" : "light";
    themeButton.textContent = dark ? "light" : "dark";
    document.querySelectorAll(".key[data-filter]").forEach((k) => { k.style.borderColor = colour(+k.dataset.filter); });
    document.querySelectorAll(".key[data-tint]").forEach((k) => { k.style.borderColor = css(k.dataset.tint); });
    draws.forEach((draw) => draw());
  };
  let dark = prefersDark.matches;
  themeButton.addEventListener("click", () => { dark = !dark; dress(dark); });
  prefersDark.addEventListener("change", (event) => { dark = event.matches; dress(dark); });
  // Paper is white.
  addEventListener("beforeprint", () => { root.dataset.print = ""; dress(false); });
  addEventListener("afterprint", () => { delete root.dataset.print; dress(dark); });
  let width = innerWidth;
  addEventListener("resize", () => {
    resize();
    if (Math.abs(innerWidth - width) > 40) { width = innerWidth; draws.forEach((draw) => draw()); }
  });
  dress(dark);
})();
