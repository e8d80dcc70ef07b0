#pragma once
/// \file The help once more for other programs, written from the options that the verbs declare and from nothing else.
#include <string>

namespace CLI {
class App;
}

namespace bough::cli {

/// The manual page bough(1), in the man macros of roff.
std::string make_man_page(const CLI::App& app);

/// The completion script for bash: verbs, the options of each verb, the values of options that take a few words; else
/// file names.
std::string make_bash_completion(const CLI::App& app);

}  // namespace bough::cli
