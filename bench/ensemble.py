#!/usr/bin/python3
"""Measures effective draws per CPU second of emcee's affine-invariant ensemble sampler for the posterior of the six signals.

Needs Debian's python3-emcee, which scripts/setup does not install, and `scripts/build release --target
rigcal_posterior_study`. The density is computed by the code of `fit --posterior`, without gradients
(build/release/bench/rigcal_posterior_study --replay). Only its CPU time counts, not that of Python, so that a
comparison with `scripts/posterior-study --speed` is one of samplers, not of languages.

    bench/ensemble.py [STEPS]
"""

import pathlib
import subprocess
import sys

try:
    import emcee
    import numpy
except ModuleNotFoundError as missing:
    sys.exit(f"ensemble.py: {sys.executable} has no module {missing.name}: install Debian's package "
             f"python3-{missing.name} and run bench/ensemble.py by /usr/bin/python3")

STUDY = pathlib.Path(__file__).resolve().parent.parent / "build/release/bench/rigcal_posterior_study"
WALKERS = 32


def main():
    steps = int(sys.argv[1]) if len(sys.argv) > 1 else 3000
    if not STUDY.exists():
        sys.exit(f"ensemble.py: no {STUDY.name}: build it with scripts/build release --target {STUDY.name}")
    with subprocess.Popen([STUDY, "--replay"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as study:

        def ask(line):
            study.stdin.write(line + "\n")
            study.stdin.flush()
            return numpy.array(study.stdout.readline().split(), dtype=float)

        centre = ask("centre")
        covariance = ask("covariance").reshape(len(centre), -1)
        generator = numpy.random.default_rng(1)
        numpy.random.seed(1)
        begin = generator.multivariate_normal(centre, covariance, WALKERS)
        sampler = emcee.EnsembleSampler(WALKERS, len(centre), lambda y: ask(" ".join(map(repr, map(float, y))))[0])
        state = sampler.run_mcmc(begin, steps // 3)  # short warm-up, because it starts within the posterior
        sampler.reset()
        before = ask("cpu")[0]
        sampler.run_mcmc(state, steps)
        seconds = ask("cpu")[0] - before
        study.stdin.close()
    time = sampler.get_autocorr_time(quiet=True)
    draws = WALKERS * steps / time.max()
    print(
        f"emcee {emcee.__version__}: {WALKERS} walkers, {steps} steps, longest autocorrelation time {time.max():.0f}: "
        f"{draws:.0f} effective draws in {seconds:.1f} s of CPU, {draws / seconds:.1f} per second"
    )


if __name__ == "__main__":
    main()
