#pragma once
/// \file Body and system files in TOML: text to records, every error with file and line, unknown keys with the nearest
/// match.
#include "formats/records/body_spec.hpp"
#include "formats/records/input_density.hpp"
#include "formats/records/system_spec.hpp"

namespace bough::toml_files {

/// Reads a body file; an unreadable file is reported and gives a spec with its path alone.
records::BodySpec read_body_spec(const std::string& path, Diagnostics& diagnostics);
/// Reads the spec from the text of the file `path`, which is not opened.
records::BodySpec read_body_spec_text(const std::string& text, const std::string& path, Diagnostics& diagnostics);
/// `set`: parameters with other numbers (TOML text) than in the file; its text in the record has them too.
records::SystemSpec read_system_spec(const std::string& path, Diagnostics& diagnostics,
                                     const std::vector<std::pair<std::string, std::string>>& set = {});
/// Reads the spec from the text of the file `path`, which is not opened; tables that it names are.
records::SystemSpec read_system_spec_text(const std::string& text, const std::string& path, Diagnostics& diagnostics);
/// Reports "toml.changed" for each difference of two texts of a system file that a run cannot go on with: all but its
/// end, its samples and its limits. `path` names the second.
void check_same_system(const std::string& before, const std::string& after, const std::string& path,
                       Diagnostics& diagnostics);
/// "FILE", "FILE:NAME", or ":NAME" of the common file; not resolved.
records::MatrixSource parse_matrix_source(const std::string& text, const std::string& common);
/// The [[psd]] of a file for bough response --psd. Reports "linear.bad-psd" (negative, not Hermitian, lengths), toml.*.
std::vector<records::InputDensity> read_input_densities(const std::string& path, Diagnostics& diagnostics);
/// Kind of a file by its tables: "body", "system", "campaign", "psd", or empty.
std::string detect_kind(const std::string& path);

}  // namespace bough::toml_files
