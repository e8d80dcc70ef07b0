#pragma once
/// \file Nodes of a body that a system file names, for completion.
#include <string>
#include <vector>

namespace bough::analysis {

/// Ids of the nodes of a body of the text: its own list, or those of its file. Empty where the file cannot be read:
/// completion has no messages.
std::vector<std::string> list_body_nodes(const std::string& text, const std::string& system_file,
                                         const std::string& body);

}  // namespace bough::analysis
