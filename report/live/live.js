// The live model of a page: controls, the worker that simulates, and the curves.
"use strict";
(() => {
  const rig = JSON.parse(document.getElementById("live-rig").textContent);
  const $ = (id) => document.getElementById("live-" + id);
  const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const make = (tag, attributes = {}, ...children) => {
    const node = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
      if (value === false || value == null) continue;
      if (name === "text") node.textContent = value; else node.setAttribute(name, value === true ? "" : value);
    }
    node.append(...children);
    return node;
  };
  const bytes = (base64) => Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
  const digits = (value, count = 4) => {
    if (value == null || !Number.isFinite(value)) return "–";
    const rounded = +value.toPrecision(count);
    return rounded !== 0 && Math.abs(rounded) < 1e-3 ? rounded.toExponential() : String(rounded);
  };
  /** Writes a score. A score below 1 is never rounded to 1. */
  const score = (value) => value > 0.99995 && value < 1 ? "> 0.9999" : digits(+value?.toFixed(4));
  const problem = (text) => {
    $("problem").textContent = text;
    $("problem").hidden = !text;
  };

  // State of the page: case, drive and parameter values, in SI.
  const rows = new Map(rig.parameters.map((row) => [row.index, row]));
  const byKey = new Map(rig.parameters.map((row) => [row.key, row]));
  const driven = rig.driven;
  const fieldsOfDrive = [
    {key: "frequency", label: "Frequency", unit: "Hz", si: 1, lower: 0.01, upper: 100, highest: 1000, scale: "log", made: true},
    {key: "end_frequency", label: "End frequency", unit: "Hz", si: 1, lower: 0.01, upper: 100, highest: 1000, scale: "log", chirp: true, made: true},
    {key: "amplitude", label: "Amplitude", unit: driven.unit, si: driven.si, lower: 0, upper: null, highest: 1e3, scale: "cubic", made: true},
    {key: "duration", label: "Duration", unit: "s", si: 1, lower: 0.05, upper: 60, highest: 600, scale: "log", made: true},
  ];
  let state;
  let tolerance = rig.tolerance;
  const caseOf = (name) => rig.cases.find((each) => each.name === name) ?? rig.cases[0];

  const begin = (chosen) => {
    state = {
      case: chosen.name, waveform: chosen.waveform, frequency: chosen.frequency, amplitude: chosen.amplitude,
      duration: chosen.duration ?? 4 / chosen.frequency, end_frequency: chosen.end_frequency ?? 10 * chosen.frequency,
      values: new Map(chosen.values),
    };
  };

  // The address stores how the state differs from the case. It has a mark on pages with other
  // sections.
  const marked = rig.embedded ? "live&" : "";
  const driveKeys = ["waveform", "frequency", "amplitude", "duration", "end_frequency"];
  const address = () => {
    const chosen = caseOf(state.case);
    const was = state;
    begin(chosen);
    const begun = state;
    state = was;
    const query = new URLSearchParams();
    if (chosen !== rig.cases[0]) query.set("case", chosen.name);
    for (const key of driveKeys) if (state[key] !== begun[key]) query.set(key, state[key]);
    for (const [index, value] of state.values)
      if (value !== begun.values.get(index)) query.set(rows.get(index).key, value);
    if (tolerance !== rig.tolerance) query.set("tolerance", tolerance);
    const text = query.toString();
    return text ? marked + text : "";
  };
  const isOurs = () => !rig.embedded || location.hash.startsWith("#" + marked);
  /** Whether the drive is unchanged from the case, so that the case's record can be compared. */
  const asRecorded = () => {
    const chosen = caseOf(state.case);
    return Boolean(chosen.times) && state.waveform === chosen.waveform &&
      (state.waveform === "recorded" || (state.frequency === chosen.frequency && state.amplitude === chosen.amplitude && state.duration === chosen.duration &&
        (state.waveform !== "chirp" || state.end_frequency === chosen.end_frequency)));
  };
  const readAddress = () => {
    const query = new URLSearchParams(isOurs() ? location.hash.slice(1 + marked.length) : "");
    begin(caseOf(query.get("case")));
    for (const [key, text] of query) {
      const value = Number(text);
      if (key === "waveform" && (rig.waveforms.includes(text) || (text === "recorded" && caseOf(state.case).recorded))) state.waveform = text;
      if (text === "" || !Number.isFinite(value)) continue;
      const field = fieldsOfDrive.find((each) => each.key === key);
      if (field && value >= (field.key === "amplitude" ? 0 : 1e-3) && value <= field.highest) state[key] = value;
      if (key === "tolerance" && value >= 1e-12 && value <= 1e-2) tolerance = value;
      const row = byKey.get(key);
      if (row && inLimits(row, value)) state.values.set(row.index, value);
    }
  };
  const inLimits = (row, value) => value >= (row.lowest ?? -Infinity) && value <= (row.highest ?? Infinity);
  let writing = 0;
  const writeAddress = () => {
    clearTimeout(writing);
    writing = setTimeout(() => {
      const text = address();
      if (!text && !isOurs()) return;
      try { history.replaceState(null, "", text ? "#" + text : location.pathname + location.search); } catch { /* an embedded page may have no address */ }
    }, 250);
  };

  // A control is a number in a readable unit, with a slider if it has a range.
  const toSlider = ({lower, upper, scale}, value) => {
    const v = Math.min(Math.max(value, lower), upper);
    if (scale === "log") return Math.log(v / lower) / Math.log(upper / lower);
    const part = (v - lower) / (upper - lower);
    return scale === "cubic" ? Math.cbrt(part) : part;
  };
  const fromSlider = ({lower, upper, scale}, s) => {
    const value = scale === "log" ? lower * (upper / lower) ** s : lower + (upper - lower) * (scale === "cubic" ? s ** 3 : s);
    return +value.toPrecision(4);
  };
  /** Position of the centre of the thumb, which is 16 pixels wide. */
  const place = (part) => `calc(8px + (100% - 16px) * ${part})`;
  const controls = new Map();
  /** @param about  {key, label, symbol, unit, si, slider, lowest, highest, get, set, begun} */
  const control = (about) => {
    const id = "live-of-" + about.key;
    const number = make("input", {id, type: "number", step: "any", inputmode: "decimal", min: about.lowest == null ? null : about.lowest / about.si,
                                  max: about.highest == null ? null : about.highest / about.si});
    const label = make("label", {for: id, text: about.label});
    if (about.symbol) {
      const {letter, subscript, argument} = about.symbol;
      label.append(make("var", {class: "symbol"}, letter, ...(subscript ? [make("sub", {text: subscript})] : []), argument));
    }
    const node = make("div", {class: "control"}, label,
                      make("span", {class: "field"}, number, make("span", {class: "unit", text: about.unit})));
    const range = about.slider && make("input", {type: "range", min: 0, max: 1, step: 0.001, "aria-label": `${about.label}, slider`});
    const mark = range && make("span", {class: "mark"});
    if (range) {
      const slide = make("span", {class: "slide"});
      if (about.interval) {
        const [low, high] = about.interval.map((end) => toSlider(about.slider, end));
        slide.append(make("span", {class: "interval", style: `left: ${place(low)}; width: max(3px, calc((100% - 16px) * ${high - low}))`, title: "95 % interval of the estimate"}));
      }
      slide.append(mark, range);
      node.append(slide);
    }
    const show = (except) => {
      const value = about.get();
      if (except !== number) number.value = digits(value / about.si, 6);
      if (range) {
        if (except !== range) range.value = toSlider(about.slider, value);
        range.setAttribute("aria-valuetext", `${digits(value / about.si)} ${about.unit}`);
        mark.style.left = place(toSlider(about.slider, about.begun()));
      }
      node.classList.toggle("changed", value !== about.begun());
      number.title = value === about.begun() ? "" : `was ${digits(about.begun() / about.si)} ${about.unit}`;
    };
    const take = (value, from) => {
      about.set(value);
      show(from);
      changed();
    };
    number.addEventListener("input", () => { if (number.value !== "" && number.checkValidity()) take(+number.value * about.si, number); });
    number.addEventListener("change", () => show());
    range?.addEventListener("input", () => take(fromSlider(about.slider, +range.value), range));
    controls.set(about.key, {show, node});
    return node;
  };
  const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);
  const begunValue = (index) => new Map(caseOf(state.case).values).get(index);
  /** Returns the 95 % interval of an estimate in this case. */
  const intervalOf = (row) => {
    const chosen = caseOf(state.case);
    const found = rig.intervals?.find((each) => each.index === row.index && (each.scope === "rig" || each.level === (each.scope === "condition" ? chosen.id : chosen.level)));
    return found ? [found.low, found.high] : row.interval;
  };
  const ofParameter = (row) => control({
    key: row.key, label: capital(row.key.replaceAll("_", " ")), symbol: row.symbol, unit: row.unit, si: row.si, slider: row.slider, interval: intervalOf(row),
    lowest: row.lowest, highest: row.highest, get: () => state.values.get(row.index) ?? 0,
    set: (value) => state.values.set(row.index, value), begun: () => begunValue(row.index) ?? 0,
  });

  const drawControls = () => {
    controls.clear();
    const leak = rows.get(rig.leak);
    $("leak").replaceChildren(leak ? ofParameter(leak) : "");
    const presets = [{name: "No leak", coefficient: 0}, ...rig.presets.filter((each) => each.coefficient > 0)];
    $("presets").replaceChildren(...presets.map((each) => {
      const button = make("button", {type: "button", text: each.name, "data-coefficient": each.coefficient, title: `leakage coefficient ${each.coefficient}`});
      button.addEventListener("click", () => { state.values.set(rig.leak, each.coefficient); showAll(); changed(); });
      return button;
    }));
    const choose = (id, label, options, get, set) => {
      const select = make("select", {id}, ...options.map((name) => make("option", {value: name, text: name})));
      select.value = get();
      select.addEventListener("change", () => { set(select.value); });
      return make("div", {class: "control"}, make("label", {for: id, text: label}), make("span", {class: "field"}, select));
    };
    const chosen = caseOf(state.case);
    const parts = [];
    if (rig.cases.length > 1) {
      parts.push(choose("live-case", "Begin with", rig.cases.map((each) => each.name), () => state.case, (name) => {
        begin(caseOf(name));
        drawControls();
        document.getElementById("live-case").focus();
        changed();
      }));
    }
    const waveforms = [...rig.waveforms, ...(chosen.recorded ? ["recorded"] : [])];
    parts.push(choose("live-waveform", "Waveform", waveforms, () => state.waveform, (name) => {
      state.waveform = name;
      showAll();
      changed();
    }));
    for (const field of fieldsOfDrive) {
      const upper = field.upper ?? Math.max(5 * chosen.amplitude, 10 * field.si);
      parts.push(control({...field, slider: {lower: field.lower, upper, scale: field.scale}, lowest: field.key === "amplitude" ? 0 : 1e-3, highest: field.highest,
                          get: () => state[field.key], set: (value) => { state[field.key] = value; },
                          begun: () => caseOf(state.case)[field.key] ?? state[field.key]}));
    }
    $("drive").replaceChildren(...parts);
    const groups = [["estimates", "Estimates", true], ["controller", "Controller", true], ["rig", "Known values", false], ["sensors", "Sensors", false], ["initial", "Initial state", false]];
    const values = document.querySelector(".live-values");
    values.replaceChildren();
    for (const [group, title, open] of groups) {
      const of = rig.parameters.filter((row) => row.group === group && row.index !== rig.leak);
      if (of.length) values.append(make("details", {class: "group", open}, make("summary", {text: title}), ...of.map(ofParameter)));
    }
    showAll();
  };
  const showAll = () => {
    for (const each of controls.values()) each.show();
    const made = state.waveform !== "recorded";
    for (const field of fieldsOfDrive) controls.get(field.key).node.hidden = !made || (field.chirp && state.waveform !== "chirp");
    document.getElementById("live-waveform").value = state.waveform;
  };

  // Requests to the worker.
  const kMostSamples = 20000;
  const sampleRate = () => {
    const chosen = caseOf(state.case);
    const wanted = Math.max(chosen.rate ?? 0, 40 * state.frequency, state.waveform === "chirp" ? 40 * state.end_frequency : 0);
    const most = Math.min(wanted || 1000, Math.max(5000, 40 * state.frequency * state.duration) / state.duration, kMostSamples / state.duration);
    // The rate has few digits, so that the equivalent command is short.
    const step = 10 ** Math.floor(Math.log10(most));
    return [8, 5, 4, 2.5, 2, 1].map((times) => times * step).find((rate) => rate <= most * (1 + 1e-12));
  };
  const numbersOf = (base64, Type) => new Type(bytes(base64).buffer);
  const recordedOf = (chosen) => {
    if (chosen.inputs) return chosen.inputs;
    const times = numbersOf(chosen.recorded.times, Float64Array);
    const inputs = {times};
    for (const name of ["drive", "load", "supply", "tank", "base", "temperature"]) {
      const signal = chosen.recorded[name];
      if (signal) inputs[name] = {kind: signal.linear ? "linear" : "held", times, values: Float64Array.from(numbersOf(signal.values, Float32Array))};
    }
    return chosen.inputs = inputs;
  };
  const timesOf = (chosen) => {
    if (typeof chosen.times === "string") chosen.times = numbersOf(chosen.times, Float64Array);
    else if (chosen.times.count) {
      const {start, step, count} = chosen.times;
      chosen.times = Float64Array.from({length: count}, (_, i) => start + i * step);
    }
    return chosen.times;
  };
  const requestOf = () => {
    const chosen = caseOf(state.case);
    const request = {plant: rig.plant, controller: rig.controller, initial: chosen.initial, method: rig.method, tolerance, seconds: 30,
                     feedback: rig.feedback, before: chosen.before, drive_begins: chosen.drive_begins, values: [...state.values],
                     of: chosen.name, recorded: asRecorded()};
    if (state.waveform === "recorded") return {...request, ...recordedOf(chosen)};
    if (request.recorded) {
      request.times = timesOf(chosen);
      request.drive = {kind: chosen.waveform, amplitude: chosen.amplitude, frequency: chosen.frequency, end: chosen.end_frequency,
                       sweep: chosen.sweep ?? chosen.duration, logarithmic: chosen.logarithmic ?? false};
      return request;
    }
    const rate = sampleRate();
    const count = Math.floor(state.duration * rate * (1 + 1e-9)) + 1;
    request.times = Float64Array.from({length: count}, (_, i) => i / rate);
    request.drive = {kind: state.waveform, amplitude: state.amplitude, frequency: state.frequency, end: state.end_frequency,
                     sweep: state.duration, logarithmic: chosen.logarithmic ?? false};
    return request;
  };

  let worker = null;
  let running = null;
  let waiting = null;
  let next = 1;
  const send = (message) => {
    if (running) { waiting = message; return; }
    running = message;
    worker.postMessage({...message.data, id: message.id, leak: rig.leak, order: rig.outputs, motion: rig.turns ? "angle_rad" : "position_m"});
  };
  /** Runs `work` with the initial state of the case, then restores the state. */
  const asBegun = (work) => {
    const was = state;
    begin(caseOf(state.case));
    try { return work(); } finally { state = was; }
  };
  /** Counts the changes of the page, so that runs for an earlier state can be stopped. */
  let changes = 0;
  const simulate = () => {
    ++changes;
    const chosen = caseOf(state.case);
    if (chosen.measured && !chosen.calibrated) {
      const calibrated = asBegun(requestOf);
      send({id: next++, data: {request: calibrated}, done: (answer) => {
        chosen.calibrated = answer.status === "ok" ? answer.outputs : rig.outputs.map(() => null);
        simulate();
      }});
      return;
    }
    const request = requestOf();
    const asked = {id: next++, data: {request}, done: (answer) => show(request, answer)};
    send(asked);
  };
  let planned = false;
  const changed = () => {
    writeAddress();
    writeCommands();
    if (planned) return;
    planned = true;
    requestAnimationFrame(() => { planned = false; simulate(); });
  };

  // Curves.
  const output = (name) => rig.outputs.indexOf(name);
  const pressures = rig.has_load_pressure
    ? [{name: "load pressure", output: "load_pressure_pa", style: "model"}]
    : [{name: "chamber A", output: "pressure_a_pa", style: "model"}, {name: "chamber B", output: "pressure_b_pa", style: "residual"}];
  const measures = (name) => rig.cases.some((each) => each.measured?.some((channel) => channel.output === name));
  const recorded = (name, label = "") => measures(name) ? [{name: "measured" + label, style: "ink", measured: name, width: 1}, {name: "calibrated" + label, style: "soft", calibrated: name}] : [];
  // A rig with a joint rotates; all other rigs move along a line.
  const motion = rig.turns ? {name: "angle", output: "angle_rad", unit: "deg", si: Math.PI / 180}
    : {name: "position", output: "position_m", unit: "mm", si: 1e-3};
  // Leak levels from the published table, otherwise from the campaign. The page of a fit has no
  // table of levels.
  const followsMotion = ["m", "rad"].includes(driven.si_unit);
  const levels = document.getElementById("live-levels") && rig.leak >= 0 ? rig.levels ?? (rig.presets.length > 1 ? rig.presets : []) : [];
  const styleOf = (k) => `level-${k % 5}`;
  const ofLevels = levels.length ? [
    {title: `${rig.turns ? "Angle" : "Position"} at each leak level`, unit: motion.unit, si: motion.si, height: 220, ofLevels: true,
     percent: followsMotion ? () => state.waveform === "recorded" ? 0 : state.amplitude / motion.si : undefined,
     lines: [...(followsMotion ? [{name: "reference", style: "reference", reference: true}] : []),
             ...levels.map(({name}, k) => ({name, style: styleOf(k), level: k, output: motion.output, width: 1.5}))]},
    {title: "Flows at each leak level: servo, and leak (dashed)", unit: "L/min", si: 1e-3 / 60, height: 220, ofLevels: true,
     lines: levels.flatMap(({name}, k) => [{name, style: styleOf(k), level: k, output: "servo_flow_m3_per_s", width: 1.5},
                                           {name: `${name} leak`, style: styleOf(k), level: k, output: "leakage_flow_m3_per_s", width: 1.5, dash: [5, 3]}])},
  ] : [];
  const plots = [
    {title: rig.turns ? "Angle" : "Position", unit: motion.unit, si: motion.si, height: 220, lines: [
      ...(followsMotion ? [{name: "reference", style: "reference", reference: true}] : []),
      ...recorded(motion.output),
      {name: "without a leak", style: "soft", healthy: true},
      {name: "live", style: "model", output: motion.output, width: 1.8}]},
    {title: "Flows", unit: "L/min", si: 1e-3 / 60, height: 180, lines: [
      {name: "servo", style: "servo", output: "servo_flow_m3_per_s"},
      {name: "work", style: "model", output: "work_flow_m3_per_s"},
      {name: "leak", style: "leak", output: "leakage_flow_m3_per_s", width: 1.8}]},
    ...ofLevels,
    {title: rig.has_load_pressure ? "Load pressure" : "Pressures", unit: "MPa", si: 1e6, height: 160, lines: pressures.flatMap((line) => [...recorded(line.output, pressures.length > 1 ? ` ${line.name.at(-1)}` : ""), line])},
    {title: `Parity residual: ${motion.name} without a leak minus live`, unit: motion.unit, si: motion.si, height: 140, lines: [
      {name: "residual", style: "residual", residual: true}]},
  ];
  const driveValues = (request) => {
    const {drive, times} = request;
    if (drive.values) return drive.values;
    const {amplitude: a, frequency: f} = drive;
    const at = {
      sine: (t) => a * Math.sin(2 * Math.PI * f * t),
      square: (t) => Math.floor(2 * f * t + 1e-9) % 2 === 0 ? a : -a,
      chirp: (t) => {
        const {end, sweep} = drive;
        const k = drive.logarithmic && end !== f ? Math.log(end / f) / sweep : 0;
        return a * Math.sin(2 * Math.PI * (k ? f * Math.expm1(k * t) / k : f * t + (end - f) * t * t / (2 * sweep)));
      },
    }[drive.kind];
    return Float64Array.from(times, at);
  };
  const scaled = (values, si) => values ? Float64Array.from(values, (v) => v / si) : null;
  /**
   * Returns the measured samples of an output in this case, at the times of the request; null if
   * there are none.
   */
  const measuredOf = (name) => {
    const chosen = caseOf(state.case);
    const channel = chosen.measured?.find((each) => each.output === name);
    if (!channel) return null;
    channel.samples ??= numbersOf(channel.values, Float32Array);
    return channel;
  };
  const dataOf = (plot, request, answer) => [request.times, ...plot.lines.map((line) => {
    if (line.measured) {
      const channel = request.recorded && measuredOf(line.measured);
      const values = new Array(request.times.length).fill(null);
      if (channel) channel.samples.forEach((v, i) => { values[i * caseOf(state.case).every] = v / plot.si; });
      return values;
    }
    if (line.calibrated) {
      const outputs = request.recorded && caseOf(state.case).calibrated?.[output(line.calibrated)];
      return outputs ? scaled(outputs, plot.si) : new Array(request.times.length).fill(null);
    }
    if (line.reference) return scaled(driveValues(request), plot.si);
    if (line.level !== undefined) return scaled(levelRuns[line.level]?.outputs[output(line.output)], plot.si) ?? new Array(request.times.length).fill(null);
    if (line.healthy) return scaled(answer.healthy, plot.si) ?? request.times.map(() => NaN);
    if (line.residual) {
      const live = answer.outputs[output(motion.output)];
      return Float64Array.from(live, (x, i) => ((answer.healthy?.[i] ?? NaN) - x) / plot.si);
    }
    return scaled(answer.outputs[output(line.output)], plot.si);
  })];
  /**
   * Results for each leak level with the drive and values of the page, in the order of `levels`.
   */
  let levelRuns = [];
  let charts = null;
  const sync = "live";
  const dashes = {calibrated: {pattern: [6, 3], border: "dashed"}, reference: {pattern: [5, 3], border: "dashed"}, healthy: {pattern: [2, 2], border: "dotted"}};
  const kindOf = (line) => Object.keys(dashes).find((kind) => line?.[kind]);
  const chartOf = (plot, data) => {
    const figure = make("figure", {class: "plot made", role: "img"}, make("figcaption", {text: `${plot.title} [${plot.unit}]`}));
    $("plots").append(figure);
    const axis = {stroke: css("--soft"), grid: {stroke: css("--rule"), width: 1}, ticks: {stroke: css("--rule")}, font: "11px system-ui, sans-serif"};
    const chart = new uPlot({
      width: figure.clientWidth || 600, height: plot.height,
      series: [{label: "time", value: (_, v) => v == null ? "–" : digits(v) + " s"},
               ...plot.lines.map((line) => ({label: line.name, stroke: css("--" + line.style), width: line.width ?? 1.2, spanGaps: Boolean(line.measured), dash: line.dash ?? dashes[kindOf(line)]?.pattern,
                                             points: {show: false}, value: (_, v) => v == null ? "–" : `${digits(v)} ${plot.unit}`}))],
      scales: {x: {time: false}},
      axes: [{...axis, size: 28, values: (_, ticks) => ticks.map((t) => digits(t) + " s")}, {...axis, size: 56, values: (_, ticks) => ticks.map((t) => digits(t))},
             ...(plot.percent ? [{...axis, side: 1, size: 52, grid: {show: false}, splits: () => [-100, -50, 0, 50, 100].map((part) => part / 100 * plot.percent()),
                                 values: (_, ticks) => ticks.map((t) => plot.percent() ? `${digits(100 * t / plot.percent(), 3)} %` : "")}] : [])],
      cursor: {sync: {key: sync, setSeries: false, scales: ["x", null]}, drag: {x: true, y: false}},
      // The mark is a piece of the line, since several lines of a chart differ by their dashes only.
      legend: {markers: {dash: (_, i) => dashes[kindOf(plot.lines[i - 1])]?.border ?? "solid"}},
    }, data, figure);
    chart.root.setAttribute("aria-hidden", "true");
    return {plot, figure, chart};
  };
  const drawPlots = (request, answer) => {
    if (!charts) charts = plots.map((plot) => chartOf(plot, dataOf(plot, request, answer)));
    else for (const {plot, chart} of charts) if (!plot.ofLevels) chart.setData(dataOf(plot, request, answer));
    for (const {plot, figure} of charts) {
      const peaks = plot.lines.filter((line) => line.output && !plot.ofLevels).map((line) =>
        `${line.name} up to ${digits(answer.outputs[output(line.output)].reduce((most, v) => Math.max(most, Math.abs(v)), 0) / plot.si)} ${plot.unit}`);
      figure.setAttribute("aria-label", [plot.title, ...peaks].join(", "));
    }
  };

  /** Computes the metrics defined in metrics/metric_table.hpp. */
  const scoresOf = (measured, simulated, every, windows) => {
    const pairs = [];
    for (const [first, last] of windows)
      for (let i = Math.ceil(first / every); i * every <= last && i < measured.length; ++i) pairs.push([measured[i], simulated[i * every]]);
    const n = pairs.length;
    const mean = (f) => pairs.reduce((sum, pair) => sum + f(pair), 0) / n;
    const my = mean(([y]) => y), ms = mean(([, s]) => s), me = my - ms;
    const vy = mean(([y]) => (y - my) ** 2), vs = mean(([, s]) => (s - ms) ** 2);
    const ve = mean(([y, s]) => (y - s - me) ** 2), cov = mean(([y, s]) => (y - my) * (s - ms));
    const square = mean(([y, s]) => (y - s) ** 2);
    const [low, high] = pairs.reduce(([least, most], [y]) => [Math.min(least, y), Math.max(most, y)], [Infinity, -Infinity]);
    return {rho2: 1 - ve / vy, r: cov / Math.sqrt(vy * vs), ccc: 2 * cov / (vy + vs + me ** 2),
            absolute_error_percent: 100 * mean(([y, s]) => Math.abs(y - s)) / (high - low), rmse: Math.sqrt(square),
            nrmse_fit_percent: 100 * (1 - Math.sqrt(square / vy)), maximum_error: pairs.reduce((most, [y, s]) => Math.max(most, Math.abs(y - s)), 0)};
  };
  const short = {rho2: "rho2", r: "R", ccc: "CCC", absolute_error_percent: "error"};
  /** Shows the scores of the live curves against the record, and whether they meet their limits. */
  const showScores = (request, answer) => {
    const chosen = caseOf(state.case);
    const place = $("scores");
    const scores = {};
    if (!chosen.measured || !request.recorded) {
      place.replaceChildren(...(chosen.measured ? [make("p", {class: "reading", text: "No record of this drive: reset it to compare."})] : []));
      return scores;
    }
    const rows = chosen.measured.map(({output: name, channel, limits}) => {
      const found = scores[channel] = scoresOf(measuredOf(name).samples, answer.outputs[output(name)], chosen.every, chosen.windows);
      const broken = limits.filter(({metric, limit, higher_is_better: higher}) => !(higher ? found[metric] >= limit : found[metric] <= limit));
      const words = !limits.length ? "no limit" : broken.length ? broken.map(({metric, limit}) => `${short[metric] ?? metric} beyond ${digits(limit)}`).join(", ") : "limits kept";
      return make("tr", {}, make("th", {scope: "row", text: channel.replaceAll("_", " ")}),
                  ...["rho2", "r", "ccc"].map((metric) => make("td", {class: "n", text: score(found[metric])})),
                  make("td", {class: "n", text: `${digits(found.absolute_error_percent, 3)} %`}),
                  make("td", {}, make("span", {class: "tag " + (!limits.length ? "" : broken.length ? "bad" : "good"), text: words})));
    });
    const about = [chosen.held_back ? "held back from the fit" : "", chosen.every > 1 ? `approximate: one of ${chosen.every} samples` : ""].filter(Boolean).join("; ");
    place.replaceChildren(make("table", {}, make("caption", {text: `Live curves against the record of ${chosen.id}${about ? ` (${about})` : ""}`}),
      make("thead", {}, make("tr", {}, ...["Channel", "rho2", "R", "CCC", "Error", "Limits"].map((text) => make("th", {scope: "col", text})))), make("tbody", {}, ...rows)));
    return scores;
  };

  const classOf = (fraction) => rig.classes.find(({below}) => below == null || fraction < below)?.name ?? "";
  let saying = 0;
  const showNumbers = (request, answer) => {
    const {flows} = answer;
    const position = answer.outputs[output(motion.output)];
    const peak = (values) => values.reduce((most, v) => Math.max(most, Math.abs(v)), 0);
    const rms = (values) => Math.sqrt(values.reduce((sum, v) => sum + v * v, 0) / values.length);
    const perMinute = (flow) => `${digits(flow * 60e3, 3)} L/min`;
    const fraction = flows.fraction == null ? null : 100 * flows.fraction;
    const leakClass = flows.fraction == null ? "" : classOf(flows.fraction);
    const items = [
      ["Servo flow", perMinute(flows.servo), "mean of its size"], ["Leak", perMinute(flows.leak), "mean of its size"],
      ["Leaked share", fraction == null ? "–" : `${digits(fraction, 3)} %`, leakClass],
      [`Peak ${motion.name}`, `${digits(peak(position) / motion.si, 4)} ${motion.unit}`, ""],
    ];
    if (followsMotion) {
      const reference = driveValues(request);
      items.push([`Error of ${motion.name}`, `${digits(rms(position.map((x, i) => reference[i] - x)) / motion.si, 3)} ${motion.unit}`, "rms against the reference"]);
    }
    if (answer.healthy) items.push(["Parity residual", `${digits(rms(position.map((x, i) => answer.healthy[i] - x)) / motion.si, 3)} ${motion.unit}`, "rms"]);
    $("numbers").replaceChildren(...items.map(([name, text, of]) => make("div", {}, make("dt", {text: name}), make("dd", {text: text + " "}, make("small", {text: of})))));
    if (document.activeElement !== $("fraction")) $("fraction").value = fraction == null ? "" : digits(fraction, 4);
    $("class").textContent = leakClass;
    $("class").className = "tag " + (["normal"].includes(leakClass) ? "good" : leakClass === "slight" ? "warn" : leakClass ? "bad" : "");
    for (const button of $("presets").children) button.setAttribute("aria-pressed", +button.dataset.coefficient === state.values.get(rig.leak));
    $("state").textContent = `${request.times.length} samples, ${answer.steps} steps, ${Math.round(answer.milliseconds)} ms`;
    clearTimeout(saying);
    saying = setTimeout(() => { $("said").textContent = items.map(([name, text, of]) => `${name} ${text} ${of}`).join("; "); }, 700);
  };
  /**
   * The table of leak levels: computed values, and below each the value published for the first
   * drive.
   */
  const features = [["servo_flow", "Servo flow", "L/min", 1e-3 / 60], ["leak_flow", "Leak flow", "L/min", 1e-3 / 60], ["mean", "mean", "", 1], ["rms", "rms", "", 1], ["std", "std", "", 1]];
  const residualFeatures = (run, healthy, from) => {
    const position = run.outputs[output(motion.output)];
    const sizes = Array.from({length: position.length - 1 - from}, (_, i) => Math.abs(healthy[from + i] - position[from + i]) * (rig.residual_scale ?? 1 / motion.si));
    const mean = sizes.reduce((sum, v) => sum + v, 0) / sizes.length;
    const rms = Math.sqrt(sizes.reduce((sum, v) => sum + v * v, 0) / sizes.length);
    return {mean, rms, std: Math.sqrt(Math.max(0, rms * rms - mean * mean))};
  };
  const published = levels.some((level) => Object.keys(level.printed ?? {}).length);
  const drivesAsPublished = () => published && state.case === rig.cases[0].name && ["waveform", "frequency", "amplitude"].every((key) => state[key] === rig.cases[0][key]);
  const showTable = (healthy) => {
    const printed = drivesAsPublished();
    const columns = features.filter(([key]) => key.endsWith("flow") || healthy);
    const unit = rig.residual_scale ? "" : ` [${motion.unit}]`;
    const rows = levels.map((level, k) => {
      const run = levelRuns[k];
      const ok = run?.status === "ok";
      const found = ok ? {servo_flow: run.flows.servo, leak_flow: run.flows.leak, ...(healthy ? residualFeatures(run, healthy, run.from) : {})} : {};
      const fraction = ok ? run.flows.fraction : null;
      const cells = columns.map(([key, , , si]) => {
        const paper = printed && level.printed?.[key];
        return make("td", {class: "n"}, make("span", {text: digits(found[key] == null ? null : found[key] / si, 3)}),
                    ...(paper ? [make("small", {text: `${digits(paper.value / si, 5)}${paper.left_out ? " *" : ""}`, title: paper.left_out ? level.reason : "published"})] : []));
      });
      const leakClass = fraction == null ? "" : classOf(fraction);
      const button = make("button", {type: "button", text: level.name, "aria-pressed": String(level.coefficient === state.values.get(rig.leak)), "data-level": k});
      button.addEventListener("click", () => {
        state.values.set(rig.leak, level.coefficient);
        showAll();
        changed();
      });
      return make("tr", {class: level.coefficient === state.values.get(rig.leak) ? "chosen" : null},
                  make("th", {scope: "row"}, make("span", {class: "swatch", style: `background: var(--${styleOf(k)})`}), button), make("td", {class: "n", text: digits(level.coefficient)}),
                  ...cells.slice(0, 2), make("td", {class: "n", text: fraction == null ? "–" : `${digits(100 * fraction, 3)} %`}),
                  make("td", {}, make("span", {class: `tag ${leakClass === "normal" ? "good" : leakClass === "slight" ? "warn" : leakClass ? "bad" : ""}`, text: leakClass || "–"})), ...cells.slice(2));
    });
    const heads = ["Leak level", "C_leak", "Servo flow [L/min]", "Leak flow [L/min]", "Share", "Class", ...columns.slice(2).map(([, title]) => `Residual ${title}${unit}`)];
    const focused = document.activeElement?.dataset?.level;
    document.getElementById("live-table").replaceChildren(make("caption", {text: `Leak levels under this drive${printed ? ", with the published numbers below" : ""}`}),
      make("thead", {}, make("tr", {}, ...heads.map((text, i) => make("th", {scope: "col", class: i && i !== 5 ? "n" : null, text})))), make("tbody", {}, ...rows));
    if (focused !== undefined) document.querySelector(`#live-table [data-level="${focused}"]`)?.focus();
    document.getElementById("live-table-notes").textContent = printed && levels.some((level) => Object.values(level.printed ?? {}).some((each) => each.left_out))
      ? "* does not agree with the other published numbers; a pointer on it shows why." : "";
  };
  /** Runs the levels one after the other. Stops if the page changes meanwhile. */
  const runLevels = (request, healthy) => {
    const begun = changes;
    const runs = [];
    const another = () => {
      if (changes !== begun || running) return;
      if (runs.length === levels.length) {
        levelRuns = runs;
        for (const {plot, chart} of charts) if (plot.ofLevels) chart.setData(dataOf(plot, request, {outputs: []}));
        showTable(healthy);
        window.rigcalLive.levels = levels.map(({name}, k) => ({name, ...runs[k].flows, ...(runs[k].status === "ok" && healthy ? residualFeatures(runs[k], healthy, runs[k].from) : {})}));
        return;
      }
      const values = [...request.values.filter(([index]) => index !== rig.leak), [rig.leak, levels[runs.length].coefficient]];
      send({id: next++, data: {request: {...request, values}, level: true}, done: (run) => { runs.push(run); another(); }});
    };
    another();
  };
  let levelsLater = 0;
  const show = (request, answer) => {
    if (request.of !== state.case) return;  // another case was chosen meanwhile, and its answer will follow
    const curves = document.querySelector(".live-curves");
    curves.classList.toggle("stale", answer.status !== "ok");
    if (answer.status !== "ok") {
      problem(`These values cannot be simulated: ${answer.status}${Number.isFinite(answer.failed_at_s) ? ` at ${digits(answer.failed_at_s)} s` : ""}: ${answer.reason}`);
      return;
    }
    problem("");
    document.body.classList.add("running");
    drawPlots(request, answer);
    showNumbers(request, answer);
    const scores = showScores(request, answer);
    if (levels.length) {
      showTable(answer.healthy);
      clearTimeout(levelsLater);
      levelsLater = setTimeout(() => runLevels(request, answer.healthy), 80);
    }
    window.rigcalLive = {request, answer, scores, rig, of: request.of, drawn: (window.rigcalLive?.drawn ?? 0) + 1};
  };

  // The `rigcal simulate` command that gives the same result.
  const quoted = (text) => /^[A-Za-z0-9_./-]+$/.test(text) ? text : `'${text.replaceAll("'", `'\\''`)}'`;
  const commands = () => {
    const was = new Map(rig.campaign);
    const made = state.waveform !== "recorded" && !asRecorded();
    const chosen = caseOf(state.case);
    const from = made ? was : new Map(chosen.campaign ?? chosen.values);
    const sets = [...state.values].filter(([index, value]) => value !== from.get(index)).map(([index, value]) => {
      const {key, si_unit: unit} = rows.get(index);
      return `--set ${key}=${quoted(unit ? `${value} ${unit}` : String(value))}`;
    });
    const id = made ? "live" : chosen.id;
    const line = ["rigcal simulate", quoted(rig.file), "--condition", id, ...sets].join(" ");
    if (!made) return line + "\n";
    const text = [
      "[[condition]]", `id = "live"`, `waveform = "${state.waveform}"`, `frequency = "${state.frequency} Hz"`,
      ...(state.waveform === "chirp" ? [`end_frequency = "${state.end_frequency} Hz"`, ...(chosen.logarithmic ? [`sweep = "logarithmic"`] : [])] : []),
      `amplitude = "${state.amplitude} ${driven.si_unit}"`, `use = "ignore"`, `duration = "${state.duration} s"`, `sample_rate = "${sampleRate()} Hz"`,
    ];
    return `# At the end of ${rig.file}:\n${text.join("\n")}\n\n# Then:\n${line}\n`;
  };
  const writeCommands = () => { $("text").textContent = commands(); };
  $("copy").addEventListener("click", async () => {
    const text = commands();
    const say = (words) => { $("said").textContent = $("state").textContent = words; };
    try {
      await navigator.clipboard.writeText(text);
      say("Copied.");
    } catch {
      $("commands").open = true;
      getSelection().selectAllChildren($("text"));
      say("Selected below: copy it with your keys.");
    }
  });
  $("reset").addEventListener("click", () => {
    tolerance = rig.tolerance;
    begin(caseOf(state.case));
    drawControls();
    for (const each of charts ?? []) each.chart.setScale("x", {min: null, max: null});
    changed();
  });
  $("fraction").addEventListener("change", () => {
    const wanted = +$("fraction").value / 100;
    if ($("fraction").value === "" || !(wanted >= 0)) return;
    send({id: next++, data: {request: requestOf(), fraction: wanted}, done: ({coefficient}) => {
      if (coefficient == null) {
        problem(`No leakage coefficient between 0.001 and 100 makes ${digits(100 * wanted)} % of the servo flow leak under this drive.`);
        return;
      }
      state.values.set(rig.leak, +coefficient.toPrecision(6));
      showAll();
      changed();
    }});
  });
  for (const form of document.querySelectorAll("#live form")) form.addEventListener("submit", (event) => event.preventDefault());

  const start = async () => {
    const packed = new Blob([bytes($("module").textContent)]).stream().pipeThrough(new DecompressionStream("gzip"));
    const module = await new Response(packed).arrayBuffer();
    worker = new Worker(URL.createObjectURL(new Blob([$("worker").textContent], {type: "text/javascript"})));
    worker.onerror = (event) => problem(`The live model does not run here: ${event.message ?? "no worker"}`);
    worker.onmessage = ({data}) => {
      const asked = running;
      running = null;
      if (asked?.id === data.id) asked.done(data); else problem(data.reason ?? "The live model does not run here.");
      if (waiting) { const message = waiting; waiting = null; send(message); }
    };
    worker.postMessage({module}, [module]);
    readAddress();
    drawControls();
    for (const node of document.querySelectorAll(levels.length ? "#live .screen, #live-levels" : "#live .screen")) node.hidden = false;
    changed();
  };
  const begun = () => start().catch((error) => {
    problem(`The live model does not run in this browser: ${error.message}`);
  });
  // A page with other sections starts the model when this section is scrolled into view.
  if (rig.embedded) {
    const seen = new IntersectionObserver((entries) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      seen.disconnect();
      begun();
    }, {rootMargin: "200px"});
    seen.observe(document.getElementById("live"));
    for (const each of rig.cases) {
      document.getElementById("condition-" + each.id)?.querySelector("h3")?.after(make("p", {class: "screen"},
        make("a", {href: `#${marked}case=${encodeURIComponent(each.name)}`, text: "Try it: this condition with other values"})));
    }
  } else {
    begun();
  }

  addEventListener("hashchange", () => {
    if (!isOurs()) return;
    if (rig.embedded) document.getElementById("try").scrollIntoView();
    if (worker && location.hash.slice(1) !== address()) { readAddress(); drawControls(); changed(); }
  });
  // A page may embed only the rig in a frame with this name. It then receives the height of the
  // content.
  if (window.parent !== window && window.name === "rigcal-part") {
    document.documentElement.classList.add("framed");
    new ResizeObserver(() => window.parent.postMessage({rigcalHeight: document.body.scrollHeight}, "*")).observe(document.body);
  }
  let resizing = 0;
  addEventListener("resize", () => {
    clearTimeout(resizing);
    resizing = setTimeout(() => charts?.forEach(({figure, chart, plot}) => chart.setSize({width: figure.clientWidth, height: plot.height})), 100);
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    if (!worker) return;  // nothing is drawn yet
    charts?.forEach(({figure, chart}) => { chart.destroy(); figure.remove(); });
    charts = null;
    changed();
  });
})();
