#include "cli/init/init_deck.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/diagnostic.hpp"

namespace bough::cli {

namespace {

bool has_constraints(const records::Deck& deck) {
  return std::any_of(deck.subcases.begin(), deck.subcases.end(), [](const auto& s) { return s.spc > 0; }) ||
         std::any_of(deck.grids.begin(), deck.grids.end(), [](const auto& g) { return g.ps != 0; });
}

// TOML: a literal string as long as the path has no quote.
std::string quote(const std::string& path) {
  if (path.find('\'') == std::string::npos) return "'" + path + "'";
  std::string text = "\"";
  for (const char c : path) text += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return text + "\"";
}

}  // namespace

std::vector<StartFile> make_start_files(const records::Deck& deck, const DeckStart& start) {
  const int grid = start.hinge_grid;
  if (grid > 0 && std::none_of(deck.grids.begin(), deck.grids.end(), [&](const auto& g) { return g.id == grid; }))
    throw InputError("cli.unknown-interface", {start.path},
                     fmt::format("interface node {} is not a grid of {}", grid, start.path), "name a GRID of the deck");
  const bool is_fixed = grid == 0 && has_constraints(deck);
  const auto& name = start.name;
  std::string frame = "frame = \"free\"           # no constraints in the deck: free-free modes\n";
  if (is_fixed) frame = "frame = \"fixed\"          # the deck's constraints hold the body frame\n";
  if (grid > 0)
    frame = fmt::format(
        "frame = \"mean\"           # not \"fixed\": modes clamped at a free hinge take nearly all inertia away from "
        "it\n"
        "interface = [{}]          # the hinge; add each grid that a hinge, force or moment loads\n",
        grid);
  const std::string body = fmt::format(
      "# bough reduce {0}.toml\n[body]\nname = \"{0}\"\ndeck = {1}\n{2}\n[body.modes]\nnumber = 10\n\n"
      "[body.output]\nfile = \"{0}.h5\"\n",
      name, quote(start.path), frame);
  std::string hinge = fmt::format("type = \"{}\"\nparent = \"ground\"\nchild = \"{}\"\n",
                                  grid > 0   ? "revolute"
                                  : is_fixed ? "fixed"
                                             : "free",
                                  name);
  if (grid > 0) hinge += fmt::format("child_node = {}\naxis = [0.0, 0.0, 1.0]\n", grid);
  const std::string system = fmt::format(
      "# bough run {0}-run.toml -o {0}-run.h5\n[[body]]\nname = \"{0}\"\nfile = \"{0}.h5\"\n\n"
      "[[hinge]]\nname = \"base\"\n{1}\n[simulation]\nduration = 1.0\noutput_step = 0.01\n",
      name, hinge);
  return {{name + ".toml", body}, {name + "-run.toml", system}};
}

}  // namespace bough::cli
