#pragma once

namespace rigcal::python {

/// Translates the errors of rigcal to the exceptions in rigcal/errors.py.
void translate_errors();

}  // namespace rigcal::python
