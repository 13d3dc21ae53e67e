#pragma once

namespace rigcal::python {

/// Errors of rigcal become the exceptions of rigcal/errors.py.
void translate_errors();

}  // namespace rigcal::python
