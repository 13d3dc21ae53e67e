"""Makes pandas tables and matplotlib figures of results, for use in a notebook.

Both packages are imported only when they are needed, so that rigcal does not depend on them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rigcal._rigcal import Campaign, Fit, Record, Result, Simulation, load

if TYPE_CHECKING:
    import pandas  # type: ignore[import]
    from matplotlib.figure import Figure  # type: ignore[import]

# The default table for each kind of result: the most interesting list in its JSON.
_TABLES = {
    "batch": "rigs",
    "comparison": "parameters",
    "diagnosis": "records",
    "fit": "parameters",
    "leak_table": "entries",
    "parity": "records",
    "plan": "parameters",
    "validation": "parameters",
}


def _suggested(name: str, known: list[str]) -> str:
    import difflib

    close = difflib.get_close_matches(name, known, 1)
    return f"no table \"{name}\"" + (f"; did you mean \"{close[0]}\"?" if close else f"; expected one of {', '.join(known)}")


def _rows(result: Fit | Result, table: str | None) -> list[dict[str, Any]]:
    content = result.json()
    known = [key for key, value in content.items() if isinstance(value, list) and value and isinstance(value[0], dict)]
    name = table if table is not None else _TABLES[result.kind]
    if name not in known:
        if table is None:
            return []
        raise KeyError(_suggested(name, known))
    rows: list[dict[str, Any]] = content[name]
    return rows


def to_frame(result: Fit | Record | Result | Simulation, table: str | None = None) -> pandas.DataFrame:
    import pandas

    if isinstance(result, Simulation):
        return pandas.DataFrame({"time_s": result.time_s, **result.signals}).set_index("time_s")
    if isinstance(result, Record):
        columns: dict[str, Any] = {"time_s": result.time_s}
        for key, channel in result.channels.items():
            columns |= {key: channel.mean, f"{key}_sd": channel.sd, f"{key}_count": channel.count}
        return pandas.DataFrame(columns).set_index("time_s")
    return pandas.json_normalize(_rows(result, table))


def _figure(rows: int = 1, **options: Any) -> tuple[Figure, Any]:
    import matplotlib.pyplot as pyplot  # type: ignore[import]

    figure, axes = pyplot.subplots(rows, layout="constrained", **options)
    pyplot.close(figure)  # otherwise the notebook would show the returned figure twice
    return figure, axes


def _plot_simulation(result: Simulation, signals: list[str] | None) -> Figure:
    motion = "angle_rad" if "angle_rad" in result.signals else "position_m"  # what the rig moves
    chosen = signals if signals is not None else [motion]
    for name in chosen:
        if name not in result.signals:
            raise KeyError(_suggested(name, list(result.signals)).replace("table", "signal"))
    figure, axes = _figure(len(chosen), sharex=True, squeeze=False)
    for axis, name in zip(axes[:, 0], chosen):
        axis.plot(result.time_s, result.signals[name])
        axis.set_ylabel(name)
    axes[-1, 0].set_xlabel("time [s]")
    axes[0, 0].set_title(result.condition)
    return figure


def _plot_record(result: Record) -> Figure:
    figure, axes = _figure(len(result.channels), sharex=True, squeeze=False)
    for axis, (key, channel) in zip(axes[:, 0], result.channels.items()):
        axis.plot(result.time_s, channel.mean)
        if channel.sd is not None:
            axis.fill_between(result.time_s, channel.mean - channel.sd, channel.mean + channel.sd, alpha=0.3)
        axis.set_ylabel(f"{key} [{channel.unit}]")
    axes[-1, 0].set_xlabel("time [s]")
    axes[0, 0].set_title(result.condition)
    return figure


def _plot_fit(result: Fit, condition: str | None, channel: str | None) -> Figure:
    scored = {key: each for key, each in result.conditions.items() if each.channels}
    if not scored:
        raise ValueError("plot: no condition was compared")

    def error(key: str) -> float:
        return max(each.metrics["absolute_error_percent"] or 0.0 for each in scored[key].channels.values())

    name = condition if condition is not None else max(scored, key=error)
    if name not in scored:
        raise KeyError(_suggested(name, list(scored)).replace("table", "condition"))
    channels = scored[name].channels
    key = channel if channel is not None else next(iter(channels))
    if key not in channels:
        raise KeyError(_suggested(key, list(channels)).replace("table", "channel"))
    shown = channels[key]
    figure, (above, below) = _figure(2, sharex=True, height_ratios=[3, 1])
    above.plot(scored[name].time_s, shown.measured, label="measured")
    above.plot(scored[name].time_s, shown.simulated, "--", label="model")
    above.set_ylabel(f"{key} [{shown.unit}]")
    above.set_title(name)
    above.legend()
    below.plot(scored[name].time_s, shown.residual, color="grey")
    below.set_ylabel("residual")
    below.set_xlabel("time [s]")
    return figure


def _intervals(labels: list[str], values: list[float], low: list[float], high: list[float], axis_label: str) -> Figure:
    figure, axis = _figure(figsize=(6.4, 1.0 + 0.28 * len(labels)))
    places = range(len(labels))
    errors = [[max(0.0, v - a) for v, a in zip(values, low)], [max(0.0, b - v) for v, b in zip(values, high)]]
    axis.errorbar(values, places, xerr=errors, fmt="o", capsize=3)
    axis.set_yticks(list(places), labels)
    axis.invert_yaxis()
    axis.set_xlabel(axis_label)
    axis.grid(axis="x", alpha=0.4)
    return figure


def _label(row: dict[str, Any]) -> str:
    return f"{row['name']} ({row['level']})" if row.get("level") else str(row["name"])


def _plot_result(result: Result) -> Figure:
    rows = _rows(result, None)
    if result.kind == "diagnosis":
        states = [row for row in _rows(result, "states") if row.get("leak_share_percent") is not None]
        ranges = [row["leak_share_ci95_percent"] or [row["leak_share_percent"]] * 2 for row in states]
        return _intervals([row["state"] for row in states], [row["leak_share_percent"] for row in states],
                          [low for low, _ in ranges], [high for _, high in ranges], "leak, percent of the servo flow")
    if result.kind == "leak_table":
        figure, axis = _figure()
        signals: dict[str, list[dict[str, Any]]] = {}
        for row in rows:
            signals.setdefault(f"{row['waveform']} {row['frequency_hz']:g} Hz", []).append(row)
        for name, points in signals.items():
            found = [(row["target_percent"], coefficient) for row in points for coefficient in row["coefficients"]]
            axis.plot(*zip(*found), "o-", label=name) if found else None
        axis.set_xlabel("leak, percent of the servo flow")
        axis.set_ylabel("leakage coefficient")
        axis.legend()
        return figure
    if result.kind == "parity":
        records = [row for row in rows if row["peak_m"] is not None]
        labels = [row["condition"] + (f", repeat {row['repeat']}" if row["repeat"] else "") for row in records]
        peaks = [1e3 * row["peak_m"] for row in records]
        return _intervals(labels, peaks, peaks, peaks, "largest parity residual [mm]")
    if result.kind == "plan":
        planned = [row for row in rows if row["value"] and row["sd_all"] is not None]
        half = [196.0 * abs(row["sd_all"] / row["value"]) for row in planned]
        zero = [0.0] * len(half)
        return _intervals([_label(row) for row in planned], zero, [-h for h in half], half,
                          "95 % interval, percent of the value")
    if result.kind == "batch":
        known = [(row["rig"], each) for row in rows for each in row["parameters"] if each["value"] and each["ci95"]]
        percent = [[100.0 * (end / each["value"] - 1.0) for end in sorted(each["ci95"])] for _, each in known]
        return _intervals([f"{rig}: {_label(each)}" for rig, each in known], [0.0] * len(known),
                          [low for low, _ in percent], [high for _, high in percent], "95 % interval, percent of the value")
    if result.kind == "comparison":
        names = [each["name"] for each in result.json()["results"]]
        labels, values, low, high = [], [], [], []
        for row in rows:
            first = row["estimates"][0]["value"] if row["estimates"][0] else None
            for name, each in zip(names, row["estimates"]):
                if not first or not each or each["value"] is None:
                    continue
                ends = each["ci95"] or [each["value"]] * 2
                labels.append(f"{_label(row)}: {name}")
                values.append(100.0 * (each["value"] / first - 1.0))
                low.append(100.0 * (min(ends) / first - 1.0))
                high.append(100.0 * (max(ends) / first - 1.0))
        return _intervals(labels, values, low, high, "difference from the first result, percent")
    return _plot_estimates(rows)


def _plot_estimates(rows: list[dict[str, Any]]) -> Figure:
    """Plots intervals around the values. Parameters that are not identified are only named, as they would hide the rest."""
    estimated = [row for row in rows if row.get("fitted")]
    shown = [row for row in estimated if row["identifiability"] == "identified" and row["value"] and row["ci95"]]
    ratios = [[100.0 * (end / row["value"] - 1.0) for end in row["ci95"]] for row in shown]
    figure = _intervals([_label(row) for row in shown], [0.0] * len(shown), [min(ends) for ends in ratios],
                        [max(ends) for ends in ratios], "95 % interval, percent of the value")
    left_out = [_label(row) for row in estimated if row not in shown]
    if left_out:
        figure.axes[0].set_title("not identified: " + ", ".join(left_out), fontsize="small")
    return figure


def loaded(*arguments: Any) -> Campaign:
    """Restores a pickled campaign by reading its file. Written in Python, since pickle cannot call a compiled function."""
    return load(*arguments)


def restored(state: tuple[Any, ...]) -> Result:
    """Restores a pickled result."""
    result: Result = Result._restored(state)  # type: ignore[attr-defined]
    return result


def plot(result: Fit | Record | Result | Simulation, *chosen: Any) -> Figure:
    if isinstance(result, Simulation):
        return _plot_simulation(result, *chosen)
    if isinstance(result, Record):
        return _plot_record(result)
    if isinstance(result, Fit):
        return _plot_fit(result, *chosen)
    return _plot_result(result)
