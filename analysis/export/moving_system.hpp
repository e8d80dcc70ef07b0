#pragma once
/// \file The moving, deforming bodies of a run, as `export --to pvd` and `--to gltf` draw them.
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "formats/hdf5/files.hpp"
#include "report/drawing.hpp"

namespace bough::analysis {

struct MovingOptions {
  int every = 1;                    ///< of the samples in the window
  std::vector<double> window;       ///< from and until; empty: all
  double scale = 1;                 ///< of the deformation
  std::string follow;               ///< the body whose origin the picture goes with; empty: inertial
  std::vector<std::string> bodies;  ///< body files of the run that are not where it found them
};
/// One row for each chosen sample. Position of Bo (minus that of the followed body) and velocity: inertial;
/// quaternion w x y z of B in the inertial frame; angular velocity in B.
struct MovingBody {
  std::string name;
  Eigen::MatrixXd position, quaternion, velocity, angular_velocity, eta, eta_dot;
  std::optional<records::FlexBody> flex;  ///< rigid without
  report::Drawing drawing;
};
struct MovingSystem {
  Eigen::VectorXd time;
  std::vector<MovingBody> bodies;
};

/// Throws InputError "cli.no-motion" for a file without bodies' channels, "cli.bad-range" for a window without a
/// sample, "cli.unknown-body". Adds the warning "export.no-body" for a body that cannot be drawn.
MovingSystem read_moving_system(const std::string& file, const MovingOptions& options, Diagnostics& diagnostics);

/// R of a quaternion w x y z that may be off unit length by round-off.
Eigen::Matrix3d to_rotation(const Eigen::Ref<const Eigen::RowVectorXd>& quaternion);

/// OUTPUT.pvd and a VTU file for each sample in the folder OUTPUT-frames (docs/formats/pvd.md); returns their number.
int write_pvd(const MovingSystem& system, double scale, bool is_ascii, const std::string& output,
              Diagnostics& diagnostics);

/// A universal file of the same mesh: places at the first sample, displacements from there at each
/// (docs/formats/uff.md).
std::string make_moving_uff(const MovingSystem& system, double scale, const std::string& name,
                            Diagnostics& diagnostics);

/// The run, or the modes of a modes file or a body, as one binary glTF file (docs/formats/gltf.md).
std::string make_glb(const std::string& file, const MovingOptions& options, Diagnostics& diagnostics);

}  // namespace bough::analysis
