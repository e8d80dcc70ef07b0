#include "cli/common/solver_option.hpp"

#include <nlohmann/json.hpp>

namespace bough::cli {

void add_solver_option(CLI::App& verb, std::string& solver) {
  verb.add_option(
      "--solver", solver,
      "Eigensolver of SLEPc: krylovschur, block-lanczos, low-rank, lobpcg, lapack, ... (default: the one that "
      "suits the model)");
}

nlohmann::json to_json(const std::vector<modal::SolverUse>& uses) {
  auto list = nlohmann::json::array();
  for (const auto& use : uses)
    list.push_back({{"eps", use.eps}, {"st", use.st}, {"factor", use.factor}, {"solutions", use.num_solves}});
  return list;
}

}  // namespace bough::cli
