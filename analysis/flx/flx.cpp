#include "analysis/flx/flx.hpp"

#include <fmt/format.h>

#include <limits>
#include <set>

#include "analysis/common/body_files.hpp"
#include "analysis/common/choices.hpp"
#include "analysis/common/failures.hpp"
#include "formats/flat/flex_body.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::analysis {

std::vector<int> choose_body_ids(const FlxRequest& request) {
  for (const int id : request.body_ids) demand_range("--body-id", id, 1, std::numeric_limits<int>::max());
  auto ids = request.body_ids;
  while (request.body_ids.size() == 1 && ids.size() < request.bodies.size()) ids.push_back(ids.back() + 1);
  if (ids.size() != request.bodies.size())
    throw InputError("cli.body-ids", {}, fmt::format("{} body ids for {} bodies", ids.size(), request.bodies.size()),
                     "give the first one, or one a body: --body-id 3,7");
  if (std::set<int>(ids.begin(), ids.end()).size() != ids.size())
    throw InputError("cli.body-ids", {}, "one body id is given twice", "give each body a different id");
  return ids;
}

std::vector<flx::FlxFile> make_flx_files(const FlxRequest& request, Diagnostics& diagnostics) {
  const auto ids = choose_body_ids(request);
  demand_range("--digits", request.digits, 2, 17);
  demand_range("--modopt", request.modopt, 0, 2);
  if (!request.integrals.empty()) demand_word("--integrals", request.integrals, {"lumped", "consistent", "exact"});
  flx::MakeOptions options{.modopt = request.modopt,
                           .method = request.integrals,
                           .has_special_nodes = request.special_nodes,
                           .has_stiffening = request.stiffening,
                           .digits = request.digits};
  std::vector<flx::FlxFile> files;
  for (std::size_t b = 0; b < ids.size(); ++b) {
    const auto& name = request.bodies[b];
    options.body_id = ids[b];
    with_file(name, [&] {
      const auto body = is_flat(name) ? flat::read_flex_body(name) : hdf5::read_flex_body(name);
      warn_of_third_order(body, name, "a .FLX file", diagnostics);
      files.push_back(flx::make_flx(body, options));
      return 0;
    });
  }
  return files;
}

std::vector<flx::FlxFile> read_flx_files(const std::string& file) {
  demand_body_file(file);
  const auto name = flx::parse_flx_name(file).value_or(flx::FlxName{file, 0});
  if (name.body_id > 0) return {flx::read_flx(name.path, name.body_id)};
  return flx::read_flx_bodies(name.path);
}

}  // namespace bough::analysis
