#include "cli/common/versions.hpp"

#include <fmt/core.h>
#include <hdf5.h>
#include <slepcversion.h>
#include <sundials/sundials_config.h>

#include <petscversion.h>
#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "base/version.hpp"

namespace bough::cli {

std::string describe_versions() {
  std::string text = fmt::format("bough {}\n", get_version());
  text += fmt::format("PETSc {}.{}.{}\n", PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR, PETSC_VERSION_SUBMINOR);
  text += fmt::format("SLEPc {}.{}.{}\n", SLEPC_VERSION_MAJOR, SLEPC_VERSION_MINOR, SLEPC_VERSION_SUBMINOR);
  text += fmt::format("HDF5 {}.{}.{}\n", H5_VERS_MAJOR, H5_VERS_MINOR, H5_VERS_RELEASE);
  text += fmt::format("SUNDIALS {}\n", SUNDIALS_VERSION);
  text += fmt::format("Eigen {}.{}.{}\n", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION);
  text += fmt::format("CLI11 {}\n", CLI11_VERSION);
  text += fmt::format("nlohmann-json {}.{}.{}\n", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                      NLOHMANN_JSON_VERSION_PATCH);
  text += fmt::format("fmt {}.{}.{}\n", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100);
  return text;
}

}  // namespace bough::cli
