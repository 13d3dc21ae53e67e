// Simulates the rig of a page in a worker. The model is a WebAssembly module
// (model/wasm/module.cpp).
"use strict";

const INPUT_KINDS = {constant: 0, sine: 1, square: 2, chirp: 3, held: 4, linear: 5};
const STATUS = ["ok", "bad parameters", "not finite", "step too small", "too many steps", "out of time", "cancelled"];

/** The module and its memory. If the module itself fails, it is instantiated again. */
class Model {
  constructor(compiled) { this.compiled = compiled; }

  start() {
    const text = (address) => {
      const bytes = new Uint8Array(this.exports.memory.buffer);
      return new TextDecoder().decode(bytes.subarray(address, bytes.indexOf(0, address)));
    };
    this.text = text;
    const system = new Proxy({
      // Only the clock is provided, for the solver's time limit. No other system calls are
      // available.
      clock_time_get: (_clock, _precision, address) => {
        new DataView(this.exports.memory.buffer).setBigUint64(address, BigInt(Math.round(performance.now() * 1e6)), true);
        return 0;
      },
      proc_exit: () => { throw new Error("the model ended: out of memory"); },
    }, {get: (known, name) => known[name] ?? (() => 52)});
    const imports = {
      rigcal: {failed: (address) => { throw new Error(text(address)); }},
    };
    for (const {module, name} of WebAssembly.Module.imports(this.compiled)) {
      imports[module] ??= {};
      imports[module][name] ??= system[name];
    }
    this.exports = new WebAssembly.Instance(this.compiled, imports).exports;
    this.exports._initialize?.();
  }

  /**
   * @param request  {plant, controller, initial, method, tolerance, values: [[index, SI value]], times, drive, load, supply, tank, base, temperature};
   *                 an input is {kind, amplitude, frequency, end, sweep, logarithmic, times, values}
   * @returns  {status: "ok", outputs: Float64Array per output, steps} or {status, reason, failed_at_s}
   */
  simulate(request) {
    if (!this.exports) this.start();
    const {exports} = this;
    const taken = [];
    const put = (numbers) => {
      const address = exports.allocate(numbers.length);
      new Float64Array(exports.memory.buffer, address, numbers.length).set(numbers);
      taken.push(address);
      return address;
    };
    const input = (signal) => {
      if (!signal) return 0;
      const samples = signal.times?.length ?? 0;
      const numbers = new Float64Array(7 + 2 * samples);
      numbers.set([INPUT_KINDS[signal.kind], samples, signal.amplitude ?? 0, signal.frequency ?? 0, signal.end ?? 0,
                   signal.sweep ?? 0, signal.logarithmic ? 1 : 0]);
      if (samples) {
        numbers.set(signal.times, 7);
        numbers.set(signal.values, 7 + samples);
      }
      return put(numbers);
    };
    try {
      const parameters = exports.parameter_count(request.plant);
      const values = new Float64Array(2 * parameters);
      for (const [index, value] of request.values) {
        values[index] = value;
        values[parameters + index] = 1;
      }
      const samples = request.times.length;
      const count = exports.output_count();
      const rig = put([request.plant, request.controller, request.initial, request.method, request.tolerance, request.seconds ?? 10,
                       request.feedback ?? 0, request.before ?? 0, request.drive_begins ?? 0]);
      const outputs = put(new Float64Array(samples * count));
      const status = exports.simulate(rig, put(values), input(request.drive), input(request.load), input(request.supply),
                                      input(request.tank), input(request.base), input(request.temperature), put(request.times), samples, outputs);
      if (status !== 0) {
        return {status: STATUS[status], reason: this.text(exports.reason()), failed_at_s: exports.failed_at_s()};
      }
      const all = new Float64Array(exports.memory.buffer, outputs, samples * count).slice();
      return {status: "ok", steps: exports.steps(),
              outputs: Array.from({length: count}, (_, k) => all.subarray(k * samples, (k + 1) * samples))};
    } catch (error) {
      this.exports = null;
      return {status: "failed", reason: error.message, failed_at_s: request.times[0]};
    } finally {
      if (this.exports) taken.forEach((address) => exports.release(address));
    }
  }
}

/** Time average of |y| from sample `from` to the last sample, with linear interpolation of y. */
const meanAbsolute = (times, y, from = 0) => {
  let sum = 0;
  for (let i = from + 1; i < y.length; ++i) {
    const a = y[i - 1];
    const b = y[i];
    const area = a * b >= 0 ? 0.5 * Math.abs(a + b) : 0.5 * (a * a + b * b) / (Math.abs(a) + Math.abs(b));
    sum += area * (times[i] - times[i - 1]);
  }
  return sum / (times[times.length - 1] - times[from]);
};

/**
 * Returns the first sample of the last whole period, or of the record if the drive is not periodic.
 */
const lastPeriod = (request) => {
  const {times, drive} = request;
  const period = drive.kind === "sine" || drive.kind === "square" ? 1 / drive.frequency : Infinity;
  const start = times[times.length - 1] - period * (1 + 1e-9);
  return start < times[0] ? 0 : times.findIndex((t) => t >= start);
};

/** Returns the mean flows in SI, and leak flow over servo flow. */
const flowsOf = (request, outputs, order) => {
  const from = lastPeriod(request);
  const mean = (name) => meanAbsolute(request.times, outputs[order.indexOf(name)], from);
  const flows = {servo: mean("servo_flow_m3_per_s"), leak: mean("leakage_flow_m3_per_s"), work: mean("work_flow_m3_per_s")};
  return {...flows, fraction: flows.servo > 0 ? flows.leak / flows.servo : null};
};

const withValue = (request, index, value) =>
  ({...request, values: [...request.values.filter(([i]) => i !== index), [index, value]]});

/**
 * Returns the smallest coefficient at which this fraction of the servo flow leaks; null if there is
 * none up to 100.
 */
const coefficientOf = (model, request, leak, fraction, order) => {
  const excess = (logarithm) => {
    const tried = withValue(request, leak, Math.exp(logarithm));
    const run = model.simulate(tried);
    return run.status === "ok" ? flowsOf(tried, run.outputs, order).fraction - fraction : NaN;
  };
  if (!(fraction > 0)) return 0;
  let low = Math.log(1e-3);
  let below = excess(low);
  if (below > 0) return null;
  for (let high = low + Math.LN2; high < Math.log(100); high += Math.LN2) {
    let above = excess(high);
    if (!(above > 0)) { low = high; below = above; continue; }
    // Regula falsi with the Illinois modification: the function value at the retained end is
    // halved.
    for (let k = 0; k < 40 && high - low > 1e-6; ++k) {
      const middle = low + (high - low) * (Number.isFinite(below / above) ? below / (below - above) : 0.5);
      const at = excess(middle);
      if (Math.abs(at) < 1e-6) return Math.exp(middle);
      if (at > 0) { high = middle; above = at; below /= 2; } else { low = middle; below = at; above /= 2; }
    }
    return Math.exp((low + high) / 2);
  }
  return null;
};

/**
 * Returns the run with its mean flows, and the motion without a leak under the same drive (not for
 * leak levels).
 */
const answer = (model, message) => {
  const {request, leak, order} = message;
  const begun = performance.now();
  if (message.fraction !== undefined) {
    return {coefficient: coefficientOf(model, request, leak, message.fraction, order)};
  }
  const run = model.simulate(request);
  if (run.status !== "ok") return run;
  if (message.level) return {...run, flows: flowsOf(request, run.outputs, order), from: lastPeriod(request)};
  const healthy = model.simulate(withValue(request, leak, 0));
  return {...run, healthy: healthy.status === "ok" ? healthy.outputs[order.indexOf(message.motion)] : null,
          flows: flowsOf(request, run.outputs, order), milliseconds: performance.now() - begun};
};

if (typeof WorkerGlobalScope !== "undefined") {
  let model = null;
  onmessage = ({data}) => {
    if (data.module) {
      try {
        model = new Model(new WebAssembly.Module(data.module));
      } catch (error) {
        postMessage({id: 0, status: "failed", reason: error.message});
      }
      return;
    }
    postMessage({id: data.id, ...answer(model, data)});
  };
}
