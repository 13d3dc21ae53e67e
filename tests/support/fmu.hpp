#pragma once

#include <dlfcn.h>
#include <zip.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <cstdarg>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/fmi/fmi2.hpp"

// A small FMU importer: unpacks the archive, reads the model description, and loads the library.

namespace rigcal::test {

/// Unpacks a ZIP archive into a folder.
inline void unzip(const std::filesystem::path& archive, const std::filesystem::path& folder) {
  int error = 0;
  std::unique_ptr<zip_t, decltype(&zip_discard)> zip(
      zip_open(archive.c_str(), ZIP_RDONLY | ZIP_CHECKCONS, &error), zip_discard);
  if (!zip) throw std::runtime_error("no ZIP archive: " + archive.string());
  for (zip_int64_t i = 0; i < zip_get_num_entries(zip.get(), 0); ++i) {
    const auto index = static_cast<zip_uint64_t>(i);
    zip_stat_t stat;
    zip_stat_index(zip.get(), index, 0, &stat);
    std::string content(stat.size, '\0');
    zip_file_t* file = zip_fopen_index(zip.get(), index, 0);
    const zip_int64_t read = zip_fread(file, content.data(), content.size());
    zip_fclose(file);
    if (read != static_cast<zip_int64_t>(content.size())) throw std::runtime_error("cut short");
    const auto path = folder / zip_get_name(zip.get(), index, 0);
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << content;
  }
}

/// A ScalarVariable of the model description.
struct Variable {
  std::size_t index = 0;  ///< counts from 1
  unsigned reference = 0;
  std::string causality;
  std::string variability;
  std::string unit;
  std::string start;
  std::size_t derivative = 0;
};

/// An FMU that was unpacked into a folder.
class Fmu {
 public:
  explicit Fmu(std::filesystem::path folder) : folder_(std::move(folder)) {
    boost::property_tree::read_xml((folder_ / "modelDescription.xml").string(), xml_);
    std::size_t index = 0;
    for (const auto& [tag, node] : description().get_child("ModelVariables")) {
      if (tag != "ScalarVariable") continue;
      Variable variable;
      variable.index = ++index;
      variable.reference = node.get<unsigned>("<xmlattr>.valueReference");
      variable.causality = node.get<std::string>("<xmlattr>.causality");
      variable.variability = node.get<std::string>("<xmlattr>.variability");
      variable.unit = node.get<std::string>("Real.<xmlattr>.unit");
      variable.start = node.get<std::string>("Real.<xmlattr>.start", "");
      variable.derivative = node.get<std::size_t>("Real.<xmlattr>.derivative", 0);
      const auto name = node.get<std::string>("<xmlattr>.name");
      if (!variables.emplace(name, variable).second)
        throw std::runtime_error("two variables have the name " + name);
    }
  }

  const boost::property_tree::ptree& description() const {
    return xml_.get_child("fmiModelDescription");
  }
  std::string guid() const { return description().get<std::string>("<xmlattr>.guid"); }
  std::string identifier() const {
    return description().get<std::string>("CoSimulation.<xmlattr>.modelIdentifier");
  }
  const std::filesystem::path& folder() const { return folder_; }
  /// As a URI, in which a blank and every byte beyond ASCII is escaped.
  std::string resources() const {
    std::string uri = "file://";
    for (const char each : (folder_ / "resources").string()) {
      const auto byte = static_cast<unsigned char>(each);
      if (byte > ' ' && byte < 0x7f && each != '%') {
        uri += each;
      } else {
        char escaped[4];
        std::snprintf(escaped, sizeof escaped, "%%%02X", static_cast<unsigned>(byte));
        uri += escaped;
      }
    }
    return uri;
  }
  std::filesystem::path library() const {
    return folder_ / "binaries" / "linux64" / (identifier() + ".so");
  }
  unsigned reference(const std::string& name) const { return variables.at(name).reference; }
  std::size_t states() const {
    std::size_t count = 0;
    for (const auto& [name, variable] : variables) count += variable.derivative > 0 ? 1 : 0;
    return count;
  }
  std::size_t indicators() const {
    return description().get<std::size_t>("<xmlattr>.numberOfEventIndicators");
  }

  std::map<std::string, Variable> variables;

 private:
  std::filesystem::path folder_;
  boost::property_tree::ptree xml_;
};

/// The shared library of an FMU. Its functions are called by name.
class FmuLibrary {
 public:
  explicit FmuLibrary(const std::filesystem::path& file)
      : handle_(::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ == nullptr) throw std::runtime_error(::dlerror());
  }
  FmuLibrary(const FmuLibrary&) = delete;
  FmuLibrary& operator=(const FmuLibrary&) = delete;
  ~FmuLibrary() { ::dlclose(handle_); }

  template <typename Function>
  Function* function(const char* name) const {
    void* found = ::dlsym(handle_, name);
    if (found == nullptr) throw std::runtime_error(std::string("the library has no ") + name);
    return reinterpret_cast<Function*>(found);
  }

 private:
  void* handle_;
};

#define RIGCAL_FMI2(library, name) (library).function<decltype(name)>(#name)

/// An instance of an FMU. It keeps the logged messages.
class FmuRun {
 public:
  FmuRun(const Fmu& fmu, const FmuLibrary& library, fmi2Type type, const std::string& guid = {})
      : fmu_(fmu), library_(library) {
    const fmi2CallbackFunctions callbacks{log, nullptr, nullptr, nullptr, &messages_};
    component = RIGCAL_FMI2(library, fmi2Instantiate)("run", type,
                                                      (guid.empty() ? fmu.guid() : guid).c_str(),
                                                      fmu.resources().c_str(), &callbacks, 0, 0);
  }
  FmuRun(const FmuRun&) = delete;
  FmuRun& operator=(const FmuRun&) = delete;
  ~FmuRun() { RIGCAL_FMI2(library_, fmi2FreeInstance)(component); }

  /// The logged messages, one per line.
  const std::string& messages() const { return messages_; }

  void initialize(double start, double tolerance,
                  const std::map<std::string, double>& values = {}) {
    require(RIGCAL_FMI2(library_, fmi2SetupExperiment)(component, 1, tolerance, start, 0, 0.0));
    for (const auto& [name, value] : values) require(set(name, value));
    require(RIGCAL_FMI2(library_, fmi2EnterInitializationMode)(component));
    require(RIGCAL_FMI2(library_, fmi2ExitInitializationMode)(component));
  }

  fmi2Status set(const std::string& name, double value) {
    const fmi2ValueReference reference = fmu_.reference(name);
    return RIGCAL_FMI2(library_, fmi2SetReal)(component, &reference, 1, &value);
  }
  double get(const std::string& name) {
    const fmi2ValueReference reference = fmu_.reference(name);
    double value = 0.0;
    require(RIGCAL_FMI2(library_, fmi2GetReal)(component, &reference, 1, &value));
    return value;
  }
  fmi2Status set_slope(const std::string& name, double value) {
    const fmi2ValueReference reference = fmu_.reference(name);
    const fmi2Integer order = 1;
    return RIGCAL_FMI2(library_, fmi2SetRealInputDerivatives)(component, &reference, 1, &order,
                                                              &value);
  }
  fmi2Status step(double time, double length) {
    return RIGCAL_FMI2(library_, fmi2DoStep)(component, time, length, 1);
  }

  /// Throws the logged messages if the status is not ok.
  void require(fmi2Status status) const {
    if (status != fmi2OK) throw std::runtime_error("the FMU says: " + messages_);
  }
  const FmuLibrary& library() const { return library_; }
  const Fmu& fmu() const { return fmu_; }

  fmi2Component component = nullptr;

 private:
  static void log(fmi2ComponentEnvironment environment, fmi2String /*instance*/,
                  fmi2Status /*status*/, fmi2String /*category*/, fmi2String message, ...) {
    char text[1024];
    std::va_list arguments;
    va_start(arguments, message);
    std::vsnprintf(text, sizeof text, message, arguments);
    va_end(arguments);
    *static_cast<std::string*>(environment) += std::string(text) + "\n";
  }

  const Fmu& fmu_;
  const FmuLibrary& library_;
  std::string messages_;
};

/// Model exchange by the classical Runge-Kutta method with a fixed step.
class ExchangeRun {
 public:
  explicit ExchangeRun(FmuRun& run) : run_(run), x_(run.fmu().states()) {
    event();
    run_.require(
        RIGCAL_FMI2(run_.library(), fmi2GetContinuousStates)(run_.component, x_.data(), x_.size()));
  }

  /// Handles event mode at the present time, and adopts the states if they changed.
  void event() {
    auto& library = run_.library();
    run_.require(RIGCAL_FMI2(library, fmi2EnterEventMode)(run_.component));
    run_.require(RIGCAL_FMI2(library, fmi2NewDiscreteStates)(run_.component, &info_));
    run_.require(RIGCAL_FMI2(library, fmi2EnterContinuousTimeMode)(run_.component));
    if (info_.valuesOfContinuousStatesChanged != fmi2False)
      run_.require(
          RIGCAL_FMI2(library, fmi2GetContinuousStates)(run_.component, x_.data(), x_.size()));
  }

  /// @param drive  called before the derivatives at a time are requested
  template <typename Drive>
  void advance(double from, double to, int steps, const Drive& drive) {
    const double h = (to - from) / steps;
    for (int i = 0; i < steps; ++i) {
      const double t = from + i * h;
      const auto k1 = slope(t, x_, drive);
      const auto k2 = slope(t + 0.5 * h, moved(k1, 0.5 * h), drive);
      const auto k3 = slope(t + 0.5 * h, moved(k2, 0.5 * h), drive);
      const auto k4 = slope(t + h, moved(k3, h), drive);
      for (std::size_t j = 0; j < x_.size(); ++j)
        x_[j] += h / 6.0 * (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j]);
    }
    put(to, x_);
  }

  const fmi2EventInfo& info() const { return info_; }

 private:
  void put(double t, const std::vector<double>& x) {
    run_.require(RIGCAL_FMI2(run_.library(), fmi2SetTime)(run_.component, t));
    run_.require(
        RIGCAL_FMI2(run_.library(), fmi2SetContinuousStates)(run_.component, x.data(), x.size()));
  }
  template <typename Drive>
  std::vector<double> slope(double t, const std::vector<double>& x, const Drive& drive) {
    put(t, x);
    drive(t);
    std::vector<double> dx(x.size());
    run_.require(
        RIGCAL_FMI2(run_.library(), fmi2GetDerivatives)(run_.component, dx.data(), dx.size()));
    return dx;
  }
  std::vector<double> moved(const std::vector<double>& slope, double h) const {
    std::vector<double> x = x_;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += h * slope[i];
    return x;
  }

  FmuRun& run_;
  fmi2EventInfo info_{};
  std::vector<double> x_;
};

}  // namespace rigcal::test
