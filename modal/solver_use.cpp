#include "modal/solver_use.hpp"

#include <slepceps.h>

#include <algorithm>

#include "base/diagnostic.hpp"
#include "fe/linear/petsc.hpp"
#include "modal/extraction.hpp"

namespace bough::modal {

void add_use(const SolverUse& use, std::vector<SolverUse>& uses) {
  const auto same = std::find_if(uses.begin(), uses.end(), [&](const SolverUse& other) {
    return other.eps == use.eps && other.st == use.st && other.factor == use.factor;
  });
  if (same == uses.end())
    uses.push_back(use);
  else
    same->num_solves += use.num_solves;
}

std::string describe_uses(const std::vector<SolverUse>& uses) {
  std::string text;
  for (const auto& use : uses)
    text += (text.empty() ? "" : "\n             ") + ("SLEPc " + use.eps) + ", ST " + use.st + ", " + use.factor +
            ", " + std::to_string(use.num_solves) + (use.num_solves == 1 ? " solve" : " solves");
  return text.empty() ? "none, no eigenvalue besides those of rigid-body modes" : text;
}

std::string find_eps_type(const std::string& name) {
  detail::initialize_slepc();
  std::string known;
  const char** types = nullptr;
  int number = 0;
  linear::check_petsc(PetscFunctionListGet(EPSList, &types, &number));
  std::vector<std::string> names;
  for (int i = 0; i < number; ++i)
    if (types[i]) names.emplace_back(types[i]);  // the last of the list may be none
  linear::check_petsc(PetscFree(types));
  std::sort(names.begin(), names.end());
  for (const auto& type : names) {
    if (type == name || type == "bough-" + name) return type;
    known += (known.empty() ? "" : ", ") + (type.rfind("bough-", 0) == 0 ? type.substr(6) : type);
  }
  throw InputError("modal.unknown-solver", {}, "SLEPc has no eigensolver '" + name + "'", "choose one of " + known);
}

}  // namespace bough::modal
