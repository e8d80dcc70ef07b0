#pragma once
/// \file Requests of the studio's page as JSON, each answered by a process with the folder of the studio as its working
/// folder. All of them call functions of analysis, formats and cli that the commands call too.
#include <string>

namespace bough::cli {

/// Answers one request, {"what": "deck", "file": "wing.bdf", ...}: {"result": {...}}, or {"messages": [...]} with the
/// messages of what failed. Throws nothing.
std::string answer_request(const std::string& request);

/// Reads a request from stdin and prints its answer as the last line of stdout.
int answer_standard_input();

}  // namespace bough::cli
