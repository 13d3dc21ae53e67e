#include "apps/rigcal/processes.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "common/error.hpp"

namespace rigcal::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kModule = "rigcal_mpi.so";

int number_in(const char* variable) {
  const char* text = std::getenv(variable);
  int number = 0;
  if (text != nullptr) {
    const std::string_view view(text);
    std::from_chars(view.data(), view.data() + view.size(), number);
  }
  return number;
}

/// Checks the environment variables that the launcher sets: mpirun from Open MPI, mpirun from
/// MPICH, or srun with PMIx. PMIx does not set the number of processes.
bool is_one_of_several() {
  return number_in("OMPI_COMM_WORLD_SIZE") > 1 || number_in("PMI_SIZE") > 1 ||
         (std::getenv("PMIX_RANK") != nullptr && number_in("SLURM_NTASKS") > 1);
}

/// Returns the path of the MPI module: next to the program in the build tree, otherwise where it is
/// installed.
fs::path module_file() {
  std::error_code unknown;
  const fs::path program = fs::read_symlink("/proc/self/exe", unknown).parent_path();
  for (const fs::path& file :
       {program / kModule, program.parent_path() / "lib" / "rigcal" / kModule}) {
    if (fs::exists(file, unknown)) return file;
  }
  return {};
}

}  // namespace

std::unique_ptr<TaskFarm> launched_processes() {
  if (!is_one_of_several()) return nullptr;
  const fs::path file = module_file();
  if (file.empty())
    throw UsageError(
        fmt::format("started as one of several MPI processes, but {} is missing: expected a rigcal "
                    "that was built with MPI (docs/many-rigs.md), or a single process",
                    kModule));
  // Open MPI loads plugins that need its symbols to be global.
  void* const module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL);
  if (module == nullptr)
    throw UsageError(fmt::format("{}: cannot be loaded: {}", file.string(), ::dlerror()));
  using MakeFarm = TaskFarm* (*)();
  const auto make = reinterpret_cast<MakeFarm>(::dlsym(module, "rigcal_mpi_farm"));
  if (make == nullptr)
    throw UsageError(fmt::format("{}: is not a module of rigcal: {}", file.string(), ::dlerror()));
  return std::unique_ptr<TaskFarm>(make());
}

int processes_on_this_machine() {
  const int open_mpi = number_in("OMPI_COMM_WORLD_LOCAL_SIZE");
  return open_mpi > 0 ? open_mpi : 1;
}

}  // namespace rigcal::app
