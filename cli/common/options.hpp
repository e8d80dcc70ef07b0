#pragma once
/// \file Options that several verbs share, declared once.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "cli/verbs.hpp"
#include "fe/model/model.hpp"
#include "formats/records/body_spec.hpp"
#include "formats/records/deck.hpp"

namespace bough::cli {

class Console;

struct CommonOptions {
  std::string output;
  bool quiet = false;
  int verbosity = 0;
  bool json = false;
  bool no_clobber = false;
};

/// A verb of the program. One unit makes them all: half of CLI11 comes with it, 100 kB of code a unit.
CLI::App* add_verb(CLI::App& app, const std::string& name, const std::string& what);

enum Offers : unsigned { kOutput = 1, kJson = 2 };

/// Adds -q, -v and, as `offers` says, -o/--output with --no-clobber and --force, and --json.
void add_common_options(CLI::App& verb, CommonOptions& options, unsigned offers, const std::string& output_help = {});

/// Before the work: throws when the output cannot be meant or written. InputError("cli.output-exists") when the file is
/// there and --no-clobber was given, InputError("cli.output-is-input") when it is one of the inputs,
/// ComputationError("cli.write") when its folder is missing or closed, or when it is no regular file.
void check_output(const CommonOptions& options, const std::string& path, const std::vector<std::string>& inputs = {});

/// Checks several outputs of one call, of which empty ones are left out; InputError("cli.same-output") if two of them
/// are one file.
void check_outputs(const CommonOptions& options, const std::vector<std::string>& paths,
                   const std::vector<std::string>& inputs = {});

/// Returns true if writing to `path` reaches a file in `folder` or below, symbolic links followed.
bool is_inside(const std::string& path, const std::string& folder);

/// From now on check_place, and check_output with it, refuses files that do not lie in this folder or below, with
/// InputError "cli.output-outside": the steps of a campaign write in the folder of their case. Empty: anywhere.
void confine_outputs(const std::string& folder);
void check_place(const std::string& path);

/// A report, to the output file when one is given, else to stdout: JSON always, text unless quiet.
void write_report(const CommonOptions& options, const Console& console, const std::string& text);

/// Returns true if the text ends so, case aside: ".h5", ".toml".
bool has_suffix(const std::string& path, const std::string& suffix);

/// Reads a deck on the first rank and hands it to the others. Collective.
records::Deck read_deck_once(const std::string& path, const std::vector<std::string>& ignore_cards,
                             Diagnostics& diagnostics);
/// Reads a body file on the first rank and hands it to the others. Collective.
records::BodySpec read_body_spec_once(const std::string& path, Diagnostics& diagnostics);
/// Reads a deck, throws InputError with all its errors; warnings stay in `diagnostics`. Collective.
records::Deck read_deck_or_throw(const std::string& path, const fe::ModelOptions& options, Diagnostics& diagnostics);
/// (file name, SHA-256) of each; nothing on the ranks that write no file.
std::vector<std::pair<std::string, std::string>> calc_sources(const std::vector<std::string>& files);

/// Runs `act`; its failure is thrown again after the `prior` messages, so that none of them is lost.
void with_prior_messages(const Diagnostics& prior, const std::function<void()>& act);

/// Runs `act`; its failures without location get the location `file`, and so do those of fe and modal with the location
/// `excluded_file`, a file whose numbers were not used.
int with_file(const std::string& file, const std::function<int()>& act, const std::string& excluded_file = "");

/// Throws InputError("cli.no-file") when the path is no readable file.
void demand_file(const std::string& path);
/// Throws InputError("cli.wrong-file") when a TOML file is of another kind than the one expected ("body", "system"),
/// with the command that takes it; "" is unknown and passes: the reader reports missing parts.
void demand_kind(const std::string& path, const std::string& kind, const std::string& expected);
/// Demands that the file is a deck; InputError("cli.wrong-file") if it is HDF5 or TOML.
void demand_deck(const std::string& path);

}  // namespace bough::cli
