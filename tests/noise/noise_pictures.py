"""The pictures of docs/noise.md: one recording with its terms, and the demonstration of S1."""

from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from navigation_error import DENSITY, RATE, SECONDS, demonstration
from noise_draws import INTERVAL, drawn

from inertial.estimation.allan import AllanSums
from inertial.estimation.multiresolution import Powers, WelchSums, segment_for
from inertial.estimation.noise_model import TERMS, NoiseModel
from inertial.estimation.noise_terms import noise_terms

matplotlib.use("Agg")
COLOURS = ("#4477aa", "#228833", "#ccbb44", "#ee6677", "#aa3377")
OSCILLATION = 12.3  # Hz; hidden in the recording that is drawn, to be marked
RECORDING = 1  # of the draws: one of several stretches
SHOWN = 3  # of the gyros


def terms_picture(file: Path) -> None:
    """Allan deviation and spectrum of a recording, with the fitted model over both."""
    values, stretches = drawn("all", RECORDING)
    sums, powers = AllanSums(1), Powers(1, INTERVAL)
    welch = WelchSums(1, INTERVAL, segment_for([len(stretch) for stretch in stretches]))
    for stretch in stretches:
        time = INTERVAL * np.arange(len(stretch))
        wave = (
            values["white_noise"] / np.sqrt(INTERVAL) / 10 * np.sin(2 * np.pi * OSCILLATION * time)
        )
        for taken in (sums, powers, welch):
            taken.add(stretch + wave[:, None])
            taken.end()
    (found,) = noise_terms(powers)
    if found is None:
        raise ValueError("nothing found")
    figure = Figure(figsize=(11.5, 4.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    curve = sums.result(INTERVAL, [found.model])
    left.fill_between(
        curve.tau, curve.lower[:, 0], curve.upper[:, 0], color="0.75", label="1 sigma"
    )
    left.plot(curve.tau, curve.deviation[:, 0], "k.", ms=4, label="overlapping Allan deviation")
    tau = np.geomspace(curve.tau[0], curve.tau[-1], 200)
    spectrum = welch.spectrum()
    marked = spectrum.in_ranges(found.lines)
    right.plot(spectrum.frequency[~marked], spectrum.density[~marked, 0], "k.", ms=4, label="Welch")
    right.plot(
        spectrum.frequency[marked], spectrum.density[marked, 0], "x", color="tab:red",
        label="oscillation, not fitted",
    )  # fmt: skip
    frequency = np.geomspace(spectrum.frequency[0], 0.499 / INTERVAL, 300)
    for name, colour in zip(TERMS, COLOURS, strict=True):
        alone = NoiseModel(**{name: getattr(found.model, name)})
        label = f"{name.replace('_', ' ')} {_told(found.terms[name])}"
        left.plot(tau, np.sqrt(alone.allan_variance(tau)), "--", lw=1, color=colour, label=label)
        if name != "ramp":
            right.plot(frequency, alone.density(frequency, INTERVAL), "--", lw=1, color=colour)
    left.plot(tau, np.sqrt(found.model.allan_variance(tau)), color="tab:blue", label="all terms")
    right.plot(frequency, found.model.density(frequency, INTERVAL), color="tab:blue")
    low, high = curve.deviation.min(), curve.deviation.max()
    left.set(xlabel="averaging time, s", ylabel="Allan deviation, rad/s", ylim=(low / 3, high * 2))
    low, high = spectrum.density.min(), spectrum.density.max()
    right.set(
        xlabel="frequency, Hz", ylabel="density of both sides, rad²/s", ylim=(low / 3, high * 2)
    )
    _finished(figure, (left, right), file)


def _told(term: object) -> str:
    value, sigma = getattr(term, "value", np.nan), getattr(term, "sigma", np.nan)
    return f"{value:.3g} ± {sigma:.1g}" if np.isfinite(value) else "(limit)"


def navigation_picture(file: Path) -> None:
    """S1: the same density, other bandwidth, other RMS, the same error of the angle."""
    found = demonstration()
    figure = Figure(figsize=(11.5, 4.2), layout="constrained")
    rates, densities, angles = figure.subplots(1, 3)
    shown = int(2 * RATE)
    for one, colour in zip(found, COLOURS, strict=False):
        label = f"{one.bandwidth:g} Hz: RMS {1e3 * one.rms:.2f} mrad/s"
        rates.plot(np.arange(shown) / RATE, 1e3 * one.rates[:shown, SHOWN], color=colour, lw=0.6,
                   label=label)  # fmt: skip
        welch = WelchSums(one.rates.shape[1], one.interval, 2048)
        welch.add(one.rates)
        welch.end()
        spectrum = welch.spectrum()
        below = spectrum.frequency < 1.2 * one.bandwidth
        densities.loglog(
            spectrum.frequency[below], np.sqrt(spectrum.density[below].mean(axis=1)), color=colour
        )
        time = np.arange(1, len(one.angle) + 1) / RATE
        label = f"{one.bandwidth:g} Hz: {1e3 * one.error:.3f} mrad RMS at {SECONDS:g} s"
        angles.plot(time, 1e3 * one.angle[:, SHOWN], color=colour, lw=1, label=label)
    sigma = 1e3 * DENSITY * np.sqrt(time)
    angles.fill_between(time, -sigma, sigma, color="0.9", label="N √t")
    densities.axhline(DENSITY, color="k", ls=":", lw=1)
    rates.set(xlabel="time, s", ylabel="rate of one gyro, mrad/s")
    densities.set(
        xlabel="frequency, Hz", ylabel="√ density, rad/√s", ylim=(DENSITY / 30, 3 * DENSITY)
    )
    angles.set(xlabel="time, s", ylabel="its angle, mrad")
    for axes in (rates, angles):
        axes.legend(fontsize=7)
    for axes in (rates, densities, angles):
        axes.grid(alpha=0.3)
    figure.savefig(file, dpi=110, metadata={"Software": None})


def _finished(figure: Figure, both: tuple[Axes, Axes], file: Path) -> None:
    for axes in both:
        axes.set(xscale="log", yscale="log")
        axes.grid(alpha=0.3)
        axes.legend(fontsize=7)
    figure.savefig(file, dpi=110, metadata={"Software": None})
