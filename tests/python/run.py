"""Runs a test file with pytest, or skips it if pytest is not installed. usage: run.py FILE"""
import sys

try:
    import pytest
except ImportError:
    print("skipped: it needs python3-pytest (scripts/setup --dev)")
    sys.exit(77)

code = pytest.main(["-q", "-p", "no:cacheprovider", *sys.argv[1:]])
sys.exit(int(code))
