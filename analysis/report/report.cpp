#include "analysis/report/report.hpp"

#include <filesystem>

#include "analysis/common/body_files.hpp"
#include "analysis/common/channels.hpp"
#include "analysis/common/choices.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/report/report_files.hpp"
#include "base/version.hpp"

namespace bough::analysis {

std::string choose_report_name(const ReportRequest& request) {
  return std::filesystem::path(get_body_path(request.files.front())).stem().string();
}

std::string make_report(const ReportRequest& request, Events& events) {
  demand_files(request.files);
  for (const auto& file : request.files) demand_body_file(file);
  Diagnostics diagnostics;
  report::Page page{
      request.title.empty() ? choose_report_name(request) : request.title, std::string("Bough ") + get_version(), {}};
  for (const auto& file : request.files) {
    if (!has_suffix(file, ".json")) warn_incomplete(file, diagnostics);
    page.chapters.push_back(make_chapter(file, request, diagnostics));
  }
  if (auto overlay = report::make_overlay(page.chapters); !overlay.panels.empty())
    page.chapters.insert(page.chapters.begin(), std::move(overlay));
  add_messages(diagnostics, events);
  return report::make_page(page);
}

}  // namespace bough::analysis
