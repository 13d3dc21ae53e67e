#!/usr/bin/env python3
"""Writes statistics.txt next to this file: the statistics in metrics/, computed with SciPy and statsmodels.

Needs Debian's python3-scipy and python3-statsmodels; the tests themselves need neither. Run this again after
changing a case:  /usr/bin/python3 make_statistics_golden.py

Each line has a name and its numbers; for a function, these are its arguments and then its value. Series are
rounded to six decimals, so that both sides read the same doubles.
"""

import pathlib

import numpy
from scipy import integrate, stats
from scipy.signal import lfilter, periodogram
from statsmodels.regression.linear_model import WLS
from statsmodels.stats.diagnostic import acorr_ljungbox
from statsmodels.stats.multitest import multipletests
from statsmodels.stats.proportion import proportion_confint
from statsmodels.stats.stattools import durbin_watson
from statsmodels.tsa.arima_process import ArmaProcess
from statsmodels.tsa.stattools import acf, acovf, levinson_durbin

INTERVAL_S = 0.01


def rounded(values):
    return numpy.round(values, 6)


def distributions():
    for p in (0.001, 0.2, 0.975, 0.99999):
        yield "normal_quantile", [p, stats.norm.ppf(p)]
    for x in (-3.1, 0.4):
        yield "normal_cdf", [x, stats.norm.cdf(x)]
    for p, freedom in ((0.975, 1.5), (0.975, 4), (0.9, 37.3), (0.01, 1e4)):
        yield "student_t_quantile", [p, freedom, stats.t.ppf(p, freedom)]
    for t, freedom in ((-2.1, 3.7), (0.6, 12)):
        yield "student_t_cdf", [t, freedom, stats.t.cdf(t, freedom)]
    for x, freedom in ((0.3, 1), (30.1, 25), (9.9, 2.5)):
        yield "chi_squared_exceedance", [x, freedom, stats.chi2.sf(x, freedom)]
    for x, above, below in ((2.2, 7, 11), (1.3, 40.5, 162), (0.4, 3, 200)):
        yield "fisher_f_exceedance", [x, above, below, stats.f.sf(x, above, below)]
    for k, n, p in ((3, 11, 0.5), (0, 4, 0.1)):
        yield "binomial_cdf", [k, n, p, stats.binom.cdf(k, n, p)]


def effective_size(rho, n):
    if rho[1] <= 1.96 / numpy.sqrt(n):
        return float(n)
    end = next(k for k in range(1, n) if rho[k] <= 0.0)
    return n / (1.0 + 2.0 * sum(rho[1:end]))


def residual_tests(name, e, u):
    n = len(e)
    c = e - e.mean()
    rho = acf(e, nlags=n - 1, fft=False)
    effective = effective_size(rho, n)
    tested = min(25, n // 5)
    ljung_box = acorr_ljungbox(c, lags=[tested])
    yield f"{name}.residual", e
    yield f"{name}.input", u
    yield f"{name}.autocorrelation", rho[: tested + 1]
    yield f"{name}.ljung_box", ljung_box["lb_stat"].iloc[0]
    yield f"{name}.ljung_box_p", ljung_box["lb_pvalue"].iloc[0]
    yield f"{name}.durbin_watson", durbin_watson(c)
    yield f"{name}.effective_samples", effective

    product = numpy.correlate(c, u - u.mean(), mode="full") / (n * c.std() * u.std())
    lags = min(n // 2, max(50, 4 * next(k for k in range(1, n) if rho[k] <= 1.96 / numpy.sqrt(n))))
    shown = product[n - 1 - lags : n + lags]
    peak = numpy.argmax(abs(shown))
    yield f"{name}.cross_correlation", shown[peak]
    yield f"{name}.cross_lag_s", (peak - lags) * INTERVAL_S
    tests = min(2 * lags + 1, effective)
    yield f"{name}.cross_band", stats.norm.ppf(1 - 0.025 / tests) / numpy.sqrt(effective)

    power = abs(numpy.fft.rfft(c)[1:]) ** 2
    lines = len(power)
    share = numpy.cumsum(power) / power.sum()
    yield f"{name}.periodogram_distance", max(abs(share - numpy.arange(1, lines + 1) / lines))
    # The 5 % point of Kolmogorov's distribution, which the source rounds to 1.358.
    yield f"{name}.periodogram_limit", stats.kstwobign.ppf(0.95) / numpy.sqrt(lines - 1)
    hz, density = periodogram(c, 1 / INTERVAL_S, detrend=False)
    yield f"{name}.periodogram_lowest", [hz[1], density[1]]
    yield f"{name}.periodogram_median_hz", hz[1 + next(k for k in range(lines) if share[k] >= 0.5)]
    at = numpy.argmax(power)
    yield f"{name}.periodogram_peak", [hz[1 + at], power[max(at - 1, 0) : at + 2].sum() / power.sum()]

    # For correlated samples, the statistic uses the effective sample size.
    skewness, kurtosis = stats.skew(e), stats.kurtosis(e)
    bera = stats.jarque_bera(e).statistic * effective / n
    yield f"{name}.skewness", skewness
    yield f"{name}.excess_kurtosis", kurtosis
    yield f"{name}.jarque_bera", bera
    yield f"{name}.jarque_bera_p", stats.chi2.sf(bera, 2)

    time_s = INTERVAL_S * numpy.arange(n)
    slope = stats.linregress(time_s, e).slope
    error = e.std() / numpy.sqrt(effective)
    yield f"{name}.mean", e.mean()
    yield f"{name}.mean_p", 2 * stats.norm.sf(abs(e.mean()) / error)
    yield f"{name}.slope_per_s", slope
    yield f"{name}.slope_p", 2 * stats.norm.sf(abs(slope) * time_s.std() / error)


def fitted_autoregression(gamma, n):
    fits = [(gamma[0], numpy.array([]))]
    fits += [levinson_durbin(gamma, nlags=p, isacov=True)[:2] for p in range(1, len(gamma))]
    return min(fits, key=lambda fit: n * numpy.log(fit[0]) + len(fit[1]) * numpy.log(n))


def autoregression(name, x, lags):
    n = len(x)
    gamma = acovf(x, demean=False, fft=False, nlag=lags)
    variance, phi = fitted_autoregression(gamma, n)
    process = ArmaProcess(numpy.r_[1, -phi])
    yield f"{name}.series", x
    yield f"{name}.autocovariance", gamma
    yield f"{name}.phi", phi
    yield f"{name}.variance", variance
    yield f"{name}.model_autocovariance", variance * process.acovf(lags + 1)
    # Long-run variance: 2 pi times the spectral density at frequency zero.
    long_run = variance / (1 - phi.sum()) ** 2
    yield f"{name}.effective_samples", n * variance * process.acovf(1)[0] / long_run


def significance(generator):
    p = rounded(generator.uniform(0, 0.2, 7))
    yield "holm.p", p
    yield "holm.adjusted", multipletests(p, method="holm")[1]
    for better, worse in ((8, 2), (3, 9), (6, 6)):
        yield "sign_test", [better, worse, stats.binomtest(better, better + worse).pvalue]
    x = rounded(generator.uniform(0, 40, 8))
    error = rounded(generator.uniform(0.5, 2, 8))
    # Deviations above the errors widen the interval and use Student's t; smaller ones leave the
    # errors unchanged and uses the normal distribution.
    for name, scatter in (("trend_wide", 3.0), ("trend_narrow", 0.3)):
        y = rounded(1 + 0.07 * x + scatter * error * generator.standard_normal(8))
        fit = WLS(y, numpy.c_[numpy.ones(8), x], weights=error**-2).fit()
        sd = fit.bse[1] / min(1.0, numpy.sqrt(fit.scale))
        of_slope = stats.t(6) if stats.chi2.sf(6 * fit.scale, 6) < 0.25 else stats.norm
        half = of_slope.ppf(0.975) * sd
        yield f"{name}.x", x
        yield f"{name}.y", y
        yield f"{name}.error", error
        yield f"{name}.line", [fit.params[1], fit.params[0], sd, fit.scale]
        yield f"{name}.ci95", [fit.params[1] - half, fit.params[1] + half]
        yield f"{name}.p_value", 2 * of_slope.sf(abs(fit.params[1]) / sd)
    for right, trials in ((5, 9), (0, 4), (12, 12)):
        yield "wilson", [right, trials, *proportion_confint(right, trials, method="wilson")]


def fundamental(generator):
    n, hz = 230, 1.7
    time_s = rounded(numpy.cumsum(generator.uniform(0.008, 0.012, n)))
    measured = rounded(2 + 3 * numpy.sin(2 * numpy.pi * hz * time_s + 0.4) + 0.3 * generator.standard_normal(n))
    simulated = rounded(2.4 * numpy.sin(2 * numpy.pi * hz * time_s - 0.3) + 0.3 * generator.standard_normal(n))
    # Uses whole periods at the end. If there are three or more, the first is left out as a
    # transient.
    periods = numpy.floor((time_s[-1] - time_s[0]) * hz) - 1
    counts = time_s > time_s[-1] - periods / hz
    angle = 2 * numpy.pi * hz * time_s[counts]
    design = numpy.c_[numpy.sin(angle), numpy.cos(angle), numpy.ones(counts.sum())]
    both = [numpy.linalg.lstsq(design, y[counts], rcond=None)[0] for y in (measured, simulated)]
    (gain_y, gain_s), (phase_y, phase_s) = zip(*((numpy.hypot(a, b), numpy.arctan2(b, a)) for a, b, _ in both))
    yield "fundamental.time_s", time_s
    yield "fundamental.measured", measured
    yield "fundamental.simulated", simulated
    yield "fundamental.measured_line", [gain_y, phase_y]
    degrees = numpy.degrees(phase_s - phase_y)
    yield "fundamental.comparison", [gain_s / gain_y, degrees, -degrees / 360 / hz]


def mean_absolute_value(generator):
    time_s = rounded(numpy.cumsum(generator.uniform(0.1, 1.0, 12)))
    servo = rounded(generator.standard_normal(12))
    generator.standard_normal(12)  # keeps the numbers of what follows

    def mean_absolute(y):
        def line(t):
            return abs(numpy.interp(t, time_s, y))

        pieces = [integrate.quad(line, a, b, limit=400, epsabs=1e-13)[0] for a, b in zip(time_s, time_s[1:])]
        return sum(pieces) / (time_s[-1] - time_s[0])

    yield "leak.time_s", time_s
    yield "leak.servo", servo
    yield "leak.mean_absolute", mean_absolute(servo)


def residual_features(generator):
    e = rounded(generator.standard_normal(30) + 0.3)
    yield "features.residual", e
    yield "features.values", [abs(e).mean(), numpy.sqrt((e**2).mean()), abs(e).std()]


def parzen(x):
    x = abs(x)
    return numpy.where(x <= 0.5, 1 - 6 * x**2 + 6 * x**3, 2 * numpy.clip(1 - x, 0, None) ** 3)


def score_contributions(generator):
    """Computes the covariance in calib/trust/sandwich.hpp for one channel, using dense matrices."""
    n = 150
    phase = numpy.linspace(0, 9, n)
    J = rounded(numpy.linalg.qr(numpy.c_[numpy.sin(phase), numpy.exp(-0.5 * phase)])[0])
    J = J @ numpy.linalg.inv(numpy.linalg.cholesky(J.T @ J)).T  # orthonormal except for the rounding below
    J = numpy.round(J, 12)
    noise = lfilter([1], [1, -0.7], generator.standard_normal(n))
    r = numpy.round(noise - J @ (J.T @ noise), 12)

    def root(phi):
        """Returns L in r = L u."""
        inverse = numpy.eye(n) - sum(c * numpy.eye(n, k=-1 - k) for k, c in enumerate(phi))
        return numpy.linalg.inv(inverse)

    gamma = acovf(r, demean=False, fft=False, nlag=n // 10)
    variance, phi = fitted_autoregression(gamma, n)
    # After the fit, (I - H) Sigma (I - H) is left of Sigma.
    sigma = variance * root(phi) @ root(phi).T
    left = (numpy.eye(n) - J @ J.T) @ sigma @ (numpy.eye(n) - J @ J.T)
    gamma = gamma[: len(phi) + 1] + [numpy.trace(sigma - left, offset=h) / n for h in range(len(phi) + 1)]
    variance, phi = fitted_autoregression(gamma, n)

    L = root(phi)
    sigma = variance * L @ L.T
    total = J.T @ sigma @ J
    filtered = L.T @ J
    scores = numpy.linalg.solve(L, r)[:, None] * filtered
    # Andrews, Econometrica 59, 1991, (6.2) and (6.4), for AR(1) components of variance one.
    rho = numpy.array([(s[1:] @ s[:-1]) / (s[:-1] @ s[:-1]) for s in scores.T])
    above = (4 * rho**2 * (1 - rho**2) ** 2 / (1 - rho) ** 8).sum()
    width = 2.6614 * (above / ((1 - rho**2) ** 2 / (1 - rho) ** 4).sum() * n) ** 0.2
    kernel = parzen((numpy.arange(n)[:, None] - numpy.arange(n)) / width)
    with_error = numpy.linalg.solve(L, (numpy.eye(n) - J @ J.T) @ sigma @ J) / numpy.sqrt(numpy.diag(total))
    own = with_error * filtered
    effective = n * ArmaProcess(numpy.r_[1, -phi]).acovf(1)[0] * (1 - phi.sum()) ** 2
    weights = filtered**2
    terms = weights.sum(0) ** 2 / (weights**2).sum(0)
    square = integrate.quad(lambda x: float(parzen(x)) ** 2, -1, 1, points=[-0.5, 0.5])[0]
    yield "sandwich.jacobian", J.T.ravel()
    yield "sandwich.residual", r
    yield "sandwich.noise", [variance, *phi]
    yield "sandwich.width", width
    yield "sandwich.covariance", (scores.T @ kernel @ scores).ravel()
    yield "sandwich.own", numpy.diag(own.T @ kernel @ own) / numpy.diag(total)
    yield "sandwich.effective_samples", effective
    yield "sandwich.freedom", 1 / (max(1.0, square * width) / terms + 2 / effective)


def split(draws):
    half = draws.shape[1] // 2
    return numpy.concatenate([draws[:, :half], draws[:, -half:]])


def normal_scores(draws):
    ranks = stats.rankdata(draws.ravel()).reshape(draws.shape)
    return stats.norm.ppf((ranks - 3 / 8) / (draws.size + 1 / 4))


def r_hat(draws):
    m, n = draws.shape
    within = draws.var(axis=1, ddof=1).mean()
    return numpy.sqrt(((n - 1) / n * within + draws.mean(axis=1).var(ddof=1)) / within)


def effective_draws(draws):
    """Vehtari et al. 2021, equations (10) to (13), with autocovariances from statsmodels and
    Geyer's pairs as an array."""
    m, n = draws.shape
    covariance = numpy.mean([acovf(chain, fft=False) for chain in draws], axis=0) * n / (n - 1)
    within = draws.var(axis=1, ddof=1).mean()
    pooled = (n - 1) / n * within + draws.mean(axis=1).var(ddof=1)
    rho = 1 - (within - covariance) / pooled
    rho[0] = 1
    pairs = rho[: n // 2 * 2].reshape(-1, 2).sum(axis=1)
    negative = numpy.flatnonzero(pairs <= 0)
    pairs = numpy.minimum.accumulate(pairs[: negative[0] if negative.size else None])
    return m * n / max(2 * pairs.sum() - 1, 1 / numpy.log10(m * n))


def chains(name, draws):
    split_draws = split(draws)
    folded = split(abs(draws - numpy.median(draws)))
    tails = [effective_draws(split((draws <= numpy.quantile(draws, q)).astype(float))) for q in (0.05, 0.95)]
    energies = draws[0]
    yield f"chains.{name}", draws.ravel()
    yield f"chains.{name}.shape", draws.shape
    yield f"chains.{name}.r_hat", max(r_hat(normal_scores(split_draws)), r_hat(normal_scores(folded)))
    yield f"chains.{name}.bulk", effective_draws(normal_scores(split_draws))
    yield f"chains.{name}.tail", min(tails)
    yield f"chains.{name}.energy", (numpy.diff(energies) ** 2).sum() / ((energies - energies.mean()) ** 2).sum()


def several_chains(generator):
    yield from chains("slow", rounded(lfilter([1], [1, -0.7], generator.standard_normal((4, 60)))))
    yield from chains("apart", rounded(generator.standard_normal((3, 41)) + numpy.array([[0.0], [0.0], [1.0]])))
    yield from chains("spread", rounded(generator.standard_normal((4, 50)) * numpy.array([[1.0], [1.0], [1.0], [4.0]])))
    yield from chains("alternating", rounded(lfilter([1], [1, 0.6], generator.standard_normal((4, 50)))))


def cases():
    generator = numpy.random.default_rng(20260301)
    yield from distributions()
    # The transforms of 120 and 125 samples use all samples, because these lengths have small prime
    # factors.
    white = generator.standard_normal(120)
    yield from residual_tests("white", rounded(white), rounded(generator.standard_normal(120)))
    coloured = lfilter([1], [1, -0.7], generator.standard_normal(125))
    late = 0.8 * coloured + 0.5 * generator.standard_normal(125)
    yield from residual_tests("coloured", rounded(0.4 + coloured), rounded(numpy.roll(late, -3)))
    skewed = generator.exponential(1.0, 120) + 0.004 * numpy.arange(120)
    yield from residual_tests("skewed", rounded(skewed), rounded(generator.standard_normal(120)))
    yield from autoregression("first_order", rounded(lfilter([1], [1, -0.8], generator.standard_normal(200))), 12)
    yield from autoregression("ringing", rounded(lfilter([1], [1, -1.5, 0.8], generator.standard_normal(200))), 12)
    yield from significance(generator)
    yield from fundamental(generator)
    yield from mean_absolute_value(generator)
    yield from residual_features(generator)
    yield from score_contributions(generator)
    yield from several_chains(numpy.random.default_rng(20270101))


def main():
    path = pathlib.Path(__file__).with_name("statistics.txt")
    with path.open("w", encoding="ascii") as out:
        out.write("# made by make_statistics_golden.py with SciPy and statsmodels\n")
        for name, values in cases():
            numbers = " ".join(f"{float(v):.15g}" for v in numpy.atleast_1d(values))
            out.write(f"{name} {numbers}\n")


if __name__ == "__main__":
    main()
