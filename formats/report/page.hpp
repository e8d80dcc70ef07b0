#pragma once
/// \file The report page: one HTML file that loads nothing (docs/report.md). Chapters hold static tables and pictures;
/// the script (web/) puts living ones in their place where it runs.
#include <string>
#include <utility>
#include <vector>

namespace bough::report {

enum class Verdict { Good, Warning, Bad, None };

/// One line of the health table.
struct Check {
  std::string what, value;
  Verdict verdict = Verdict::None;
  std::string note;  ///< what it is held against, or what to do
};

struct Panel {
  std::string id, title, html;
};

/// One file.
struct Chapter {
  std::string kind, title;                                 ///< "results", "spinup.h5"
  std::vector<std::pair<std::string, std::string>> facts;  ///< of the head: name, plain text
  std::vector<Check> checks;
  std::vector<Panel> panels;
  std::string data;                                           ///< JSON for the script; empty: none
  std::vector<std::pair<std::string, std::string>> settings;  ///< more facts, folded away

  /// The worst of its checks.
  Verdict get_verdict() const;
  void add_panel(const std::string& id, const std::string& panel_title, const std::string& html);
};

struct Page {
  std::string title, maker;  ///< maker: "Bough 0.1.0"
  std::vector<Chapter> chapters;
};

std::string make_page(const Page& page);

}  // namespace bough::report
