#pragma once
/// \file The chapters of a flexible body and of a modes file.
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "report/drawing.hpp"
#include "report/page.hpp"

namespace bough::report {

/// Mass integrals by three methods as modal/compare finds them; empty matrices where a method is missing.
struct IntegralsTable {
  std::array<std::string, 3> method;
  std::array<Eigen::MatrixXd, 3> norm, difference;  ///< n x 5
  Eigen::MatrixXd captured;                         ///< n x 6: share of m m m Jxx Jyy Jzz by the modes so far
};

/// Frequency against spin rate about one axis of the body frame.
struct SpinCurves {
  std::string axis;
  Eigen::VectorXd rate;
  Eigen::MatrixXd frequency_hz, without_hz;         ///< r x k
  std::vector<std::pair<double, double>> diverges;  ///< rates between which it does
  bool has_stiffness = true;
};

/// An output node of a flexible body.
struct BodyNode {
  int id = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< undeformed, body frame
  bool is_interface = false;
};

struct ModalModel {
  std::string kind, file, name;  ///< kind: "flexible body", "modes", "buckling"
  std::vector<std::pair<std::string, std::string>> facts;
  std::string frame;  ///< of the vectors: "B about Bo", "basic about the reference"
  double mass = 0;
  Eigen::Vector3d cg = Eigen::Vector3d::Zero(), reference = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about reference
  Eigen::VectorXd frequency_hz, modal_mass,
      damping;  ///< of buckling: load factors in frequency_hz; damping: ratios, may be empty
  std::vector<std::string> mode_kind;
  Eigen::VectorXd residual;        ///< may be empty
  Eigen::MatrixXd effective_mass;  ///< n x 6, may be empty
  Eigen::MatrixXd mac;             ///< of the modes among themselves, or empty
  IntegralsTable integrals;
  std::vector<SpinCurves> spin;
  std::vector<BodyNode> nodes;     ///< of a flexible body
  std::vector<std::string> loads;  ///< names of the load patterns that have a geometric stiffness
  std::vector<Check> checks;
  Drawing drawing;
  bool is_buckling = false;
};

/// Composes the chapter: animated shapes, mass properties, table of modes, mass integrals, frequencies against spin
/// rate, MAC; a panel without data is left out.
Chapter make_chapter(const ModalModel& model);

/// A matrix between 0 and 1 as squares of grey, with its numbers as titles.
std::string draw_heat_map(const std::string& title, const Eigen::MatrixXd& values, const std::string& row_label,
                          const std::string& column_label);

}  // namespace bough::report
