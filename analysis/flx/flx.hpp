#pragma once
/// \file Flexible bodies as .FLX files of TREETOPS.
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "formats/flx/flx_file.hpp"

namespace bough::analysis {

struct FlxRequest {
  std::vector<std::string> bodies;  ///< flexible bodies, HDF5 or flat
  std::vector<int> body_ids{1};     ///< one for each body, or the first, from which they are counted on
  std::string integrals;            ///< "lumped", "consistent" or "exact"; empty: the body's choice
  int modopt = 0;                   ///< 0 all integrals, 1 zero and first order, 2 zero order only
  int digits = 9;                   ///< significant digits
  bool special_nodes = false;       ///< the nodes through which a controller applies the geometric stiffness
  bool stiffening = false;          ///< K_G1, K_G2 and the preload too
};

/// Ids of the bodies. Throws InputError "cli.body-ids" unless there is one for each body, each once.
std::vector<int> choose_body_ids(const FlxRequest& request);

/// Reads the bodies and makes their blocks. Throws what choose_body_ids(), the readers and flx::make_flx() throw, with
/// the name of the body's file. Adds export.third-order (warning).
std::vector<flx::FlxFile> make_flx_files(const FlxRequest& request, Diagnostics& diagnostics);

/// Reads a .FLX file; of "panels.FLX:2" the body with the id 2.
std::vector<flx::FlxFile> read_flx_files(const std::string& name);

}  // namespace bough::analysis
