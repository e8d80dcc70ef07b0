#pragma once
/// \file The report page: one HTML file that loads nothing (docs/report.md). Chapters hold static tables and pictures;
/// the script (web/) puts living ones in their place where it runs.
#include <string>
#include <utility>
#include <vector>

#include "report/svg_plot.hpp"

namespace bough::report {

enum class Verdict { Good, Warning, Bad, None };
/// The word of a verdict, by which pages and studio choose its colour.
const char* get_word(Verdict verdict);

/// One line of the health table.
struct Check {
  std::string what, value;
  Verdict verdict = Verdict::None;
  std::string note;  ///< what it is held against, or what to do
};

struct Panel {
  std::string id, title, html;
};

/// One of the numbers at the top of a chapter: "largest deflection", "0.57 m", "boom, at t = 6.8 s".
struct Highlight {
  std::string name, value, note;
};

/// One file.
struct Chapter {
  std::string kind, title;                                 ///< "results", "spinup.h5"
  std::vector<std::pair<std::string, std::string>> facts;  ///< of the head: name, plain text
  std::vector<Check> checks;
  std::vector<Panel> panels;
  std::string data;                                           ///< JSON for the script; empty: none
  std::vector<std::pair<std::string, std::string>> settings;  ///< more facts
  std::vector<Highlight> highlights{};                        ///< at most kMaxHighlights are shown
  std::vector<Plot> curves{};                                 ///< of a run: one plot a channel, for make_overlay

  /// The worst of its checks.
  Verdict get_verdict() const;
  /// Adds a part of the page below its title; `html` is trusted. \param id  unique in the chapter, for links.
  void add_panel(const std::string& id, const std::string& panel_title, const std::string& html);
};

struct Page {
  std::string title, maker;  ///< maker: "Bough 0.1.0"
  std::vector<Chapter> chapters;
};

/// Facts, settings and the table of checks are folded, unless a check is worse than ok; the verdict, the highlights and
/// the first panel are on the first screen.
std::string make_page(const Page& page);

/// Chapter with the curves of several runs in the same charts, channel by channel; without panels for one run.
Chapter make_overlay(const std::vector<Chapter>& chapters);

}  // namespace bough::report
