#pragma once
/// \file Commands that the page may run, with the options that it may give them.
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace bough::cli {

/// Words of a command line from {"verb": "reduce", "files": ["wing.toml"], "options": [["-o", "wing.h5"], ["--free"]]}.
/// Files and outputs are relative names below `folder`. \throws InputError "studio.bad-request",
/// "cli.outside-folder".
std::vector<std::string> make_command(const nlohmann::json& request, const std::string& folder);

/// The words for a shell: "bough reduce wing.toml -o 'my wing.h5'".
std::string quote_command(const std::vector<std::string>& words);

}  // namespace bough::cli
