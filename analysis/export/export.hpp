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
  std::string file;                   ///< may name one body of a .FLX, "panels.FLX:2"
  std::string output;                 ///< file to write; needed by the formats that are no text (is_written_format)
  std::string format;                 ///< csv, vtu, pvd, gltf, bdf, mat, op4, uff, sid, mbdyn, flat, extseout or fmu
  std::vector<std::string> channels;  ///< csv, uff: only these channels; fmu: its outputs; empty: all
  bool is_ascii = false;              ///< vtu, pvd: numbers as text instead of base64
  bool is_moving = false;             ///< uff: the moving system of a run instead of its channels
  std::string fields = "large";       ///< bdf: "large", "small" or "free"
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

/// Returns true for pvd, mat, fmu and extseout, whose files export_file() writes.
bool is_written_format(const std::string& format);

/// Throws InputError "cli.no-export", "cli.no-shapes", "cli.unknown-channel" and what the readers and writers report.
ExportAnswer export_file(const ExportRequest& request, Events& events);

}  // namespace bough::analysis
