#pragma once
/// \file Results of `compare`, as tables of at most 100 columns, as JSON and as arrays of an HDF5 file.
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "formats/records/comparison.hpp"
#include "modal/compare/bodies.hpp"
#include "modal/compare/refinement.hpp"

namespace bough::cli {

using Eigen::MatrixXd;

/// One body by itself: its integrals by the three methods and what its modes capture.
struct SingleReport {
  const records::FlexBody& body;
  modal::IntegralsCheck check;
};
std::string format_report(const SingleReport& report);
nlohmann::json make_json(const SingleReport& report);
void add_arrays(const SingleReport& report, records::Comparison& file);

/// Two models; bodies only when both are.
struct PairReport {
  std::string file_a, file_b;
  modal::ModalModel a, b;
  modal::NodeMatch match;
  MatrixXd mac;
  std::optional<MatrixXd> mass_mac;
  std::vector<modal::ModePair> pairs;
  std::optional<modal::BodyComparison> bodies;
};
/// Nodes matched, MAC, pairs; of bodies nothing more. Throws InputError cli.no-common-nodes.
PairReport compare_models(const std::string& file_a, modal::ModalModel a, const std::string& file_b,
                          modal::ModalModel b);
/// Modal model of a flexible body or a modes file; throws InputError cli.not-comparable for other files.
modal::ModalModel load_model(const std::string& file, Diagnostics& diagnostics);
std::string format_report(const PairReport& report);
nlohmann::json make_json(const PairReport& report);
void add_arrays(const PairReport& report, records::Comparison& file);

struct RefinementReport {
  std::vector<std::string> files;
  std::array<double, 3> element_size;
  std::vector<modal::Convergence> rows;
};
std::string format_report(const RefinementReport& report);
nlohmann::json make_json(const RefinementReport& report);
void add_arrays(const RefinementReport& report, records::Comparison& file);

}  // namespace bough::cli
