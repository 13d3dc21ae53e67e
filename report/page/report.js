// Replaces the static pictures of the time plots by zoomable ones. The page also works without this
// script.
"use strict";
(() => {
  const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  const bytes = (base64) => Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));

  /** Unpacks values stored as 16-bit numbers of steps above `low`; 65535 is a gap. */
  const unpack = ({low, step, data}) => {
    const view = new DataView(bytes(data).buffer);
    return Array.from({length: view.byteLength / 2}, (_, i) => {
      const code = view.getUint16(2 * i, true);
      return code === 65535 ? null : low + step * code;
    });
  };

  const times = ({first_s, times}) => {
    const view = new DataView(bytes(times).buffer);
    return Float64Array.from({length: view.byteLength / 4}, (_, i) => first_s + view.getFloat32(4 * i, true));
  };

  const digits = (value) => value == null ? "–" : String(+value.toPrecision(5));

  const dashes = {reference: [5, 3]};
  const widths = {model: 1.8, leak: 1.8};

  const save = (name, url) => {
    const link = document.createElement("a");
    link.download = name;
    link.href = url;
    link.click();
  };

  /** Saves the picture as a separate file, with the colours of the page included. */
  const savePicture = (figure) => {
    const svg = figure.querySelector("svg.static").cloneNode(true);
    const shown = figure.querySelectorAll("svg.static *");
    const kept = ["stroke", "stroke-width", "stroke-dasharray", "fill", "fill-opacity", "font-size", "font-family"];
    svg.querySelectorAll("*").forEach((node, i) => {
      const style = getComputedStyle(shown[i]);
      for (const key of kept) node.style.setProperty(key, style.getPropertyValue(key));
    });
    const blob = new Blob([new XMLSerializer().serializeToString(svg)], {type: "image/svg+xml"});
    save(figure.dataset.file + ".svg", URL.createObjectURL(blob));
  };

  const saveImage = (figure, chart) => {
    const canvas = document.createElement("canvas");
    canvas.width = chart.ctx.canvas.width;
    canvas.height = chart.ctx.canvas.height;
    const context = canvas.getContext("2d");
    context.fillStyle = css("--paper");
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.drawImage(chart.ctx.canvas, 0, 0);
    save(figure.dataset.file + ".png", canvas.toDataURL("image/png"));
  };

  /** The plots of one condition, which share time axis and cursor. */
  class Group {
    /** @param data  the series; if missing, they are read from the article */
    constructor(article, data) {
      this.figures = [...article.querySelectorAll("figure.plot")];
      this.source = () => data ?? JSON.parse(article.querySelector("script.series").textContent);
      this.charts = new Map();
      this.range = null;
    }

    load() {
      if (this.data) return;
      this.data = this.source();
      this.time = times(this.data);
      this.columns = [];
      this.whole = [this.time[0], this.time[this.time.length - 1]];
      this.sync = uPlot.sync(this.figures[0].dataset.file);
    }

    column(i) {
      return this.columns[i] ??= unpack(this.data.columns[i]);
    }

    /** Shows [from, to] in every plot; null shows all. */
    zoom(from, to, source) {
      if (this.zooming) return;
      this.zooming = true;
      this.range = [Math.max(from, this.whole[0]), Math.min(to, this.whole[1])];
      for (const chart of this.charts.values())
        if (chart !== source) chart.setScale("x", {min: this.range[0], max: this.range[1]});
      this.zooming = false;
    }

    reset() { this.zoom(this.whole[0], this.whole[1]); }

    /** Zooms or moves according to the name of a key. Returns false for any other key. */
    move(key) {
      const [from, to] = this.range ?? this.whole;
      const span = to - from;
      const middle = (from + to) / 2;
      const moves = {
        "+": [middle - span / 4, middle + span / 4], "=": [middle - span / 4, middle + span / 4],
        "-": [middle - span, middle + span],
        "ArrowLeft": [Math.max(this.whole[0], from - span / 5), Math.max(this.whole[0], from - span / 5) + span],
        "ArrowRight": [Math.min(this.whole[1], to + span / 5) - span, Math.min(this.whole[1], to + span / 5)],
        "0": this.whole,
      };
      if (!moves[key]) return false;
      this.zoom(...moves[key]);
      return true;
    }

    key(event) {
      if (!event.ctrlKey && !event.metaKey && !event.altKey && this.move(event.key)) event.preventDefault();
    }

    draw(figure) {
      this.load();
      const plot = this.data.plots[+figure.dataset.plot];
      const series = [{label: "time", value: (_, v) => v == null ? "–" : digits(v) + " s"}];
      const values = [this.time];
      const bands = [];
      /**
       * Adds the band `middle` plus and minus `half`; `names` are its upper and lower edge in the
       * legend.
       */
      const addBand = (middle, half, names, fill, stroke = "transparent") => {
        bands.push({series: [series.length, series.length + 1], fill});
        for (const sign of [1, -1]) {
          series.push({label: names[sign > 0 ? 0 : 1], stroke, width: 1, dash: [4, 3], points: {show: false}, value: (_, v) => digits(v)});
          values.push(half.map((h, i) => h == null || (middle && middle[i] == null) ? null : (middle ? middle[i] : 0) + sign * h));
        }
      };
      if (plot.sd != null) addBand(this.column(plot.lines[0].column), this.column(plot.sd), ["+ sd", "- sd"], css("--measured") + "38");
      // The measured line comes last, so that it is drawn on top.
      for (const line of [...plot.lines].reverse()) {
        series.push({
          label: line.name, stroke: css("--" + line.style), width: widths[line.style] ?? 1.2, dash: dashes[line.style],
          points: {show: false}, value: (_, v) => v == null ? "–" : digits(v) + " " + plot.unit,
        });
        values.push(this.column(line.column));
      }
      // The band comes after the lines, because a residual would hide its edges.
      if (plot.prediction != null) {
        const {sd, middle, factor} = plot.prediction;
        addBand(middle == null ? null : this.column(middle), this.column(sd).map((s) => s == null ? null : factor * s),
                ["prediction, upper", "prediction, lower"], css("--model") + "30", middle == null ? css("--model") : "transparent");
      }
      const axis = {stroke: css("--soft"), grid: {stroke: css("--rule"), width: 1}, ticks: {stroke: css("--rule")}, font: "11px system-ui, sans-serif"};
      const chart = new uPlot({
        width: figure.clientWidth, height: plot.height, series, bands,
        scales: {x: {time: false}},
        axes: [{...axis, size: 28, values: (_, ticks) => ticks.map((t) => digits(t) + " s")}, {...axis, size: 64, values: (_, ticks) => ticks.map(digits)}],
        legend: {live: true},
        cursor: {sync: {key: this.sync.key, setSeries: false, scales: ["x", null]}, drag: {x: true, y: false}, focus: {prox: -1}},
        hooks: {setScale: [(u, key) => { if (key === "x" && u.status === 1) this.zoom(u.scales.x.min, u.scales.x.max, u); }]},
      }, values, figure);
      if (this.range) chart.setScale("x", {min: this.range[0], max: this.range[1]});
      // Screen readers use the label of the figure, since a canvas and its legend mean nothing to
      // them.
      chart.root.setAttribute("aria-hidden", "true");
      chart.over.addEventListener("dblclick", () => this.reset());
      this.charts.set(figure, chart);
      figure.classList.add("live");
      if (!figure.querySelector(".tools")) this.addTools(figure);
    }

    addTools(figure) {
      const tools = document.createElement("span");
      tools.className = "tools";
      const add = (text, label, action) => {
        const button = document.createElement("button");
        button.type = "button";
        button.textContent = text;
        button.setAttribute("aria-label", label);
        button.addEventListener("click", action);
        tools.append(button);
      };
      // Touch screens need buttons: they have no keys, and dragging scrolls the page.
      add("+", "Zoom in", () => this.move("+"));
      add("−", "Zoom out", () => this.move("-"));
      add("←", "Earlier", () => this.move("ArrowLeft"));
      add("→", "Later", () => this.move("ArrowRight"));
      add("Show all", "Show the whole record", () => this.reset());
      add("PNG", "Save the plot as it is shown, as PNG", () => saveImage(figure, this.charts.get(figure)));
      if (figure.querySelector("svg.static")) add("SVG", "Save the picture of the whole record as SVG", () => savePicture(figure));
      figure.querySelector("figcaption").append(tools);
      figure.addEventListener("keydown", (event) => { if (event.target === figure) this.key(event); });
    }

    redraw() {
      for (const [figure, chart] of [...this.charts]) {
        chart.destroy();
        this.draw(figure);
      }
    }

    resize() {
      for (const [figure, chart] of this.charts)
        chart.setSize({width: figure.clientWidth, height: chart.height});
    }
  }

  const element = (name, className, text = "") => Object.assign(document.createElement(name), {className, textContent: text});

  const streams = new Map();
  /** Returns the sketches in a packed script, which is unpacked only once. */
  const unpacked = (script) => {
    if (!streams.has(script)) {
      const stream = new Blob([bytes(script.textContent)]).stream().pipeThrough(new DecompressionStream("deflate"));
      streams.set(script, new Response(stream).json());
    }
    return streams.get(script);
  };

  /** Fills in the line of a condition when a reader opens it. */
  const fill = async (line) => {
    const list = line.parentElement;
    const index = [...list.querySelectorAll("details.sketch")].indexOf(line);
    const each = +list.dataset.each;
    const {texts, series} = (await unpacked(list.querySelectorAll("script.packed")[Math.floor(index / each)]))[index % each];
    for (const text of texts) line.append(element("p", "reading", text));
    if (!series) return;
    series.plots.forEach(({name, caption, description}, i) => {
      const figure = element("figure", "plot");
      Object.assign(figure.dataset, {plot: i, file: line.id + "_" + name});
      figure.tabIndex = 0;
      figure.setAttribute("role", "group");
      figure.setAttribute("aria-label", description);
      figure.append(element("figcaption", "", caption));
      line.append(figure);
    });
    const group = new Group(line, series);
    groups.push(group);
    group.figures.forEach((figure) => group.draw(figure));
  };

  const groups = [...document.querySelectorAll("article.condition")].filter((a) => a.querySelector("script.series")).map((a) => new Group(a));
  const owner = new Map(groups.flatMap((group) => group.figures.map((figure) => [figure, group])));
  // The event does not bubble, so the listener captures it.
  document.querySelector(".sketches")?.addEventListener("toggle", ({target}) => {
    if (!target.open || target.dataset.filled) return;
    target.dataset.filled = "yes";
    fill(target);
  }, true);
  /** Opens the section that hides the target of a link to a condition. */
  const reveal = () => {
    const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    (target?.matches("details.sketch") ? target : target?.querySelector(":scope > details.curves"))?.setAttribute("open", "");
  };
  addEventListener("hashchange", reveal);
  reveal();
  const seen = new IntersectionObserver((entries) => {
    for (const {isIntersecting, target} of entries) {
      if (!isIntersecting) continue;
      seen.unobserve(target);
      owner.get(target).draw(target);
    }
  }, {rootMargin: "300px"});
  for (const figure of owner.keys()) seen.observe(figure);

  let waiting = 0;
  addEventListener("resize", () => {
    clearTimeout(waiting);
    waiting = setTimeout(() => groups.forEach((group) => group.resize()), 100);
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => groups.forEach((group) => group.redraw()));
  // Sections cannot be opened on paper, so all are opened before printing.
  addEventListener("beforeprint", () => document.querySelectorAll("details:not(.sketch)").forEach((d) => { d.open = true; }));
})();
