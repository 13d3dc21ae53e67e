#include <array>

#include "metrics/metric_table.hpp"
#include "report/page/page_parts.hpp"

namespace rigcal::report {
namespace {

struct Formula {
  const char* name;
  const char* formula;
};

/// Definitions of the quantities on the page, except the metrics in metrics/metric_table.hpp.
constexpr std::array kFormulas{
    Formula{"noise floor",
            "what a model equal to the true signal would score: rho2 = 1 - sigma^2 / var(y), sigma "
            "the standard deviation of the mean of the repeats"},
    Formula{"gain ratio, phase, delay",
            "simulated over measured amplitude, and phase, of the least-squares sine at the "
            "fundamental; delay = -phase / (360 f)"},
    Formula{"verdict",
            "condition: the worst of its limits; FAIL beyond a limit, WARN beyond its warning; "
            "whole: the worst of its conditions"},
    Formula{"used fraction of a limit",
            "distance of the metric from its ideal (1, 100 % or 0) over that of the limit"},
    Formula{"cost",
            "half the sum over all samples and channels of ((s - y) / sigma)^2, priors included"},
    Formula{"reduced chi-square",
            "2 cost / (residuals - rank); 1 if noise alone explains the residuals"},
    Formula{"standard error",
            "root of the diagonal of max(1, chi-square) (J'J)^-1, J the Jacobian of the weighted "
            "residuals"},
    Formula{"robust standard error",
            "sandwich (J'J)^-1 S (J'J)^-1, S the covariance of J'r, including the correlation of "
            "the residuals r in time"},
    Formula{"intervals under the errors",
            "value ± 1.96 times each error, the plain (naive) one and the robust one"},
    Formula{
        "95 % interval",
        "value ± q times the robust standard error, truncated at the limits of the parameter; q = "
        "t / "
        "root of (1 - b + b t^2), t Student's with the degrees of freedom of that error, b the "
        "fraction of it that the error of the value itself makes up; where residuals are below "
        "half of the "
        "noise, or too few to estimate their correlation, value ± t times the plain error; half "
        "width: over the value"},
    Formula{"identified, weak, not identifiable",
            "half width of the interval up to 20 %, up to 100 %, above 100 % of the value, or of "
            "the width of the bounds if zero is arbitrary or the effect may be absent"},
    Formula{"correlation of estimates",
            "C(i,j) / root of C(i,i) C(j,j), C the covariance of the "
            "standard errors"},
    Formula{"singular values",
            "singular values of J with columns scaled to length 1; a direction with the value zero "
            "is not determined"},
    Formula{
        "profile",
        "(lowest cost with the parameter fixed - cost) over the rise at which the 95 % interval "
        "ends: 1/2 (half width / standard error)^2 max(1, chi-square)"},
    Formula{"bootstrap",
            "percentiles of fits to redrawn repeats, or residuals in blocks, widened by t over the "
            "normal quantile; bias: their mean - value"},
    Formula{"lack of fit",
            "F = variance of the residual / variance of the mean of the repeats; each sum of n "
            "squares has n / (1 + 2 sum rho^2) degrees of freedom; all tests together at 5 % "
            "(Bonferroni)"},
    Formula{"AIC, BIC",
            "2 cost w + 2 rank, 2 cost w + rank ln(n_e); n_e of n residuals independent, w = "
            "min(1, n_e / n)"},
    Formula{"shift by a condition left out",
            "largest |value without it - value| over the standard error"},
    Formula{"autocorrelation",
            "rho(k) = sum e(t) e(t-k) / sum e^2; band ± 1.96 / sqrt(n); test of Ljung and Box over "
            "25 lags"},
    Formula{"effective sample size",
            "n / (1 + 2 sum of rho) up to the first rho that is not positive"},
    Formula{"cross-correlation",
            "sum e(t) u(t-lag) / (n std(e) std(u)), u the reference or command; band by the "
            "effective sample size, Bonferroni for the peak"},
    Formula{"periodogram",
            "power of each line of the Fourier transform, averaged over 30 bins per decade; test "
            "of the cumulative periodogram (Bartlett)"},
    Formula{"quantiles",
            "quantiles of (e - mean) / std against those of the normal distribution; test of "
            "Jarque and Bera with the effective sample size"},
    Formula{"drift",
            "mean and least-squares slope of e, each against its standard error by the effective "
            "sample size"},
    Formula{"share of the servo flow",
            "mean |Q_leak| / mean |Q_servo| of the model over whole periods; a leak table finds "
            "all coefficients that give the target"},
    Formula{"error of a leak coefficient",
            "computed / published - 1, for the root with the ratio nearest to 1"},
    Formula{"weighted logarithms",
            "rms of weight ln(computed / published) over the published numbers"},
    Formula{"class of a leak",
            "from the position of the share between the limits; probabilities from the "
            "distribution of the share, given that it is not negative (docs/diagnosis.md)"},
    Formula{"smallest leak",
            "detected with the stated false alarms, and found in the stated fraction of cases "
            "(Currie's detection limit)"},
    Formula{"accuracy", "right / all; interval of Wilson"},
    Formula{"difference, p",
            "two-sided t test of (b - a) / root of the sum of squared standard errors, with the "
            "degrees of freedom of Welch and Satterthwaite; Holm's procedure for all parameters "
            "together"},
    Formula{
        "trend",
        "weighted least squares, tested by the errors of the points; where chi-square about the "
        "line exceeds its upper quartile (10 % if the errors include day-to-day variation), the "
        "error "
        "is widened by the root of reduced chi-square and tested by t with n - 2 degrees of "
        "freedom"},
    Formula{"sign test", "exact binomial, two-sided, over the conditions that both results have"},
};

}  // namespace

doc::Section formulas_section() {
  doc::Facts facts{"Formulas"};
  for (const metrics::MetricSpec& metric : metrics::kMetrics)
    facts.rows.push_back({std::string(metric.name), {std::string(metric.formula)}});
  for (const Formula& each : kFormulas) facts.rows.push_back({each.name, {each.formula}});
  return {"formulas",
          "How each number is computed",
          {doc::reading("y measured mean, s simulated, e = y - s, over the samples used; "
                        "population moments."),
           std::move(facts)}};
}

}  // namespace rigcal::report
