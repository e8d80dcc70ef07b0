#pragma once
/// \file Bodies, modes, matrices, results, systems and decks in the formats of other programs.
#include <string>
#include <variant>
#include <vector>

#include "analysis/common/events.hpp"
#include "analysis/export/export_bodies.hpp"
#include "analysis/export/export_component.hpp"
#include "analysis/export/export_fmu.hpp"
#include "analysis/export/moving_system.hpp"

namespace bough::analysis {

struct ExportRequest {
  std::string file;                       ///< may name one body of a .FLX, "panels.FLX:2"
  std::string output;                     ///< file to write; needed by the formats that are no text (is_written_format)
  std::string format;                     ///< word of an ExportFormat
  std::vector<std::string> channels;      ///< csv, uff: only these channels; fmu: its outputs; empty: all
  bool is_ascii = false;                  ///< vtu, pvd: numbers as text instead of base64
  bool is_moving = false;                 ///< uff: the moving system of a run instead of its channels
  std::string fields = "large";           ///< bdf: "large", "small" or "free"
  std::vector<std::string> ignore_cards;  ///< bdf, extseout: cards to leave out
  BodyExportOptions body;
  MovingOptions moving;
  FmuOptions fmu;
  ComponentExportOptions component;
};

struct ExportAnswer {
  std::string text;    ///< the file, of a format that is a text or one block of bytes: not written
  int num_frames = 0;  ///< of --to pvd
  std::variant<std::monostate, FmuSummary, ComponentSummary> summary;
};

/// A row of the table of formats (export.cpp); a new format is its writer and a row.
struct ExportFormat {
  const char* word;
  const char* what;                  ///< in the help: "vtu (mode shapes for ParaView)"
  const char* takes;                 ///< files of Bough that it takes
  bool is_written;                   ///< export_file() writes its files, which need an output
  std::vector<std::string> options;  ///< of the command line, "--channel", that it has; others are rejected
  /// Sets the text of the answer, or writes `request.output`.
  void (*make)(const ExportRequest& request, ExportAnswer& answer, Diagnostics& diagnostics);
};
/// Every format, in the order of the help.
const std::vector<ExportFormat>& list_export_formats();

/// Returns true for the formats whose files export_file() writes.
bool is_written_format(const std::string& format);

/// Options whose values differ from their defaults and that the format does not have.
std::vector<std::string> list_foreign_options(const ExportRequest& request);

/// Throws InputError "cli.no-export", "cli.bad-option", "cli.bad-range", "cli.no-shapes", "cli.unknown-channel" and
/// what the readers and writers report.
ExportAnswer export_file(const ExportRequest& request, Events& events);

}  // namespace bough::analysis
