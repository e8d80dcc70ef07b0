#include "report/page.hpp"

#include <algorithm>
#include <array>

#include "base/xml_text.hpp"
#include "report/html.hpp"
#include "report/web_text.hpp"

namespace bough::report {

const char* get_word(Verdict verdict) {
  constexpr std::array kWords{"ok", "look", "bad", "info"};
  return kWords[static_cast<std::size_t>(verdict)];
}

namespace {

std::string make_badge(Verdict verdict) {
  const std::string word = get_word(verdict);
  return "<span class=\"badge " + word + "\">" + word + "</span>";
}

/// JSON inside an element: no "<" may end it.
std::string shield(const std::string& data) {
  std::string text;
  text.reserve(data.size());
  for (const char c : data) {
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  }
  return text;
}

std::string make_facts(const std::vector<std::pair<std::string, std::string>>& facts) {
  std::string html = "<dl class=\"facts\">\n";
  for (const auto& [name, value] : facts)
    html += "<div><dt>" + escape_xml(name) + "</dt><dd>" + escape_xml(value) + "</dd></div>\n";
  return html + "</dl>\n";
}

constexpr std::size_t kMaxHighlights = 3;

std::string make_highlights(const Chapter& chapter) {
  if (chapter.highlights.empty()) return "";
  std::string html = "<dl class=\"highlights\">\n";
  for (std::size_t i = 0; i < std::min(kMaxHighlights, chapter.highlights.size()); ++i) {
    const auto& one = chapter.highlights[i];
    html += "<div><dt>" + escape_xml(one.name) + "</dt><dd>" + escape_xml(one.value) + "</dd><dd class=\"note\">" +
            escape_xml(one.note) + "</dd></div>\n";
  }
  return html + "</dl>\n";
}

/// "2 of 5 checks to look at: run completed, ..."; the checks themselves are in the table.
std::string sum_up(const Chapter& chapter) {
  std::size_t judged = 0, worse = 0;
  std::string list;
  for (const auto& check : chapter.checks) {
    judged += check.verdict != Verdict::None;
    if (check.verdict != Verdict::Warning && check.verdict != Verdict::Bad) continue;
    ++worse;
    list += (list.empty() ? "" : "; ") + check.what + (check.value.empty() ? "" : ": " + check.value);
  }
  if (judged == 0) return "";
  if (worse == 0 && judged == 1) return "The only check passed.";
  if (worse == 0) return "All " + std::to_string(judged) + " checks passed.";
  return std::to_string(worse) + " of " + std::to_string(judged) + " checks to look at: " + list + ".";
}

std::string make_health(const Chapter& chapter) {
  if (chapter.checks.empty()) return "";
  const auto verdict = chapter.get_verdict();
  std::string html = std::string("<details class=\"health-fold\"") +
                     (verdict == Verdict::Warning || verdict == Verdict::Bad ? " open" : "") +
                     "><summary>Health</summary>\n"
                     "<div class=\"scroll\"><table class=\"health\"><caption>Health</caption>\n<tbody>\n";
  for (const auto& check : chapter.checks)
    html += "<tr><td>" + make_badge(check.verdict) + "</td><td class=\"text\">" + escape_xml(check.what) + "</td><td>" +
            escape_xml(check.value) + "</td><td class=\"text\">" + escape_xml(check.note) + "</td></tr>\n";
  return html + "</tbody></table></div></details>\n";
}

std::string make_provenance(const Chapter& chapter) {
  std::string html;
  if (!chapter.facts.empty())
    html += "<details class=\"provenance\"><summary>File and sources</summary>\n" + make_facts(chapter.facts) +
            "</details>\n";
  if (!chapter.settings.empty())
    html += "<details><summary>Settings</summary>\n" + make_facts(chapter.settings) + "</details>\n";
  return html;
}

std::string make_panel(const Panel& panel, const std::string& chapter_id) {
  return "<section class=\"panel\" id=\"" + chapter_id + "-" + panel.id + "\">\n<h3>" + escape_xml(panel.title) +
         "</h3>\n" + panel.html + "</section>\n";
}

}  // namespace

Verdict Chapter::get_verdict() const {
  Verdict worst = Verdict::None;
  for (const auto& check : checks) {
    if (check.verdict == Verdict::Bad) return Verdict::Bad;
    if (check.verdict == Verdict::Warning) worst = Verdict::Warning;
    if (check.verdict == Verdict::Good && worst == Verdict::None) worst = Verdict::Good;
  }
  return worst;
}

void Chapter::add_panel(const std::string& id, const std::string& panel_title, const std::string& html) {
  panels.push_back({id, panel_title, html});
}

std::string make_page(const Page& page) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src '" +
      std::string(get_script_hash()) + "'; style-src '" + get_style_hash() +
      "'; img-src blob: data:; base-uri 'none'; form-action 'none'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<meta name=\"generator\" content=\"" +
      escape_xml(page.maker) + "\">\n<title>" + escape_xml(page.title) + "</title>\n<style>" + get_style() +
      "</style>\n</head>\n<body>\n<header><h1>" + escape_xml(page.title) + "</h1>\n<p class=\"note\">" +
      escape_xml(page.maker) + "</p></header>\n<nav aria-label=\"Contents\"><ul>\n";
  for (std::size_t c = 0; c < page.chapters.size(); ++c) {
    const auto& chapter = page.chapters[c];
    const std::string id = "c" + std::to_string(c);
    html += "<li><a href=\"#" + id + "\">" + escape_xml(chapter.title) + "</a> " + make_badge(chapter.get_verdict()) +
            "<ul>";
    for (const auto& panel : chapter.panels)
      html += "<li><a href=\"#" + id + "-" + panel.id + "\">" + escape_xml(panel.title) + "</a></li>";
    html += "</ul></li>\n";
  }
  html += "</ul></nav>\n<main>\n";
  for (std::size_t c = 0; c < page.chapters.size(); ++c) {
    const auto& chapter = page.chapters[c];
    const std::string id = "c" + std::to_string(c);
    html += "<section class=\"chapter\" id=\"" + id + "\" data-kind=\"" + escape_xml(chapter.kind) +
            "\" data-title=\"" + escape_xml(chapter.title) + "\">\n<h2>" + escape_xml(chapter.title) + " <small>" +
            escape_xml(chapter.kind) + "</small> " + make_badge(chapter.get_verdict()) + "</h2>\n";
    if (const auto summary = sum_up(chapter); !summary.empty())
      html += "<p class=\"summary\">" + escape_xml(summary) + "</p>\n";
    html += make_highlights(chapter);
    for (std::size_t p = 0; p < chapter.panels.size(); ++p) {
      html += make_panel(chapter.panels[p], id);
      if (p == 0) html += make_health(chapter) + make_provenance(chapter);
    }
    if (chapter.panels.empty()) html += make_health(chapter) + make_provenance(chapter);
    if (!chapter.data.empty())
      html += "<script type=\"application/json\" class=\"data\">" + shield(chapter.data) + "</script>\n";
    html += "</section>\n";
  }
  html += "</main>\n<script type=\"module\">";
  html += get_script();
  html += "</script>\n</body>\n</html>\n";
  return html;
}

Chapter make_overlay(const std::vector<Chapter>& chapters) {
  constexpr std::size_t kMaxPictures = 12;
  Chapter overlay{"comparison", "Runs in the same charts", {}, {}, {}, {}, {}};
  std::vector<const Chapter*> runs;
  for (const auto& chapter : chapters)
    if (!chapter.curves.empty()) runs.push_back(&chapter);
  if (runs.size() < 2) return overlay;
  std::string html = "<div class=\"live\" data-view=\"overlay\">\n";
  std::vector<std::string> done;
  for (const auto* run : runs)
    for (const auto& plot : run->curves) {
      if (done.size() == kMaxPictures || std::find(done.begin(), done.end(), plot.title) != done.end()) continue;
      done.push_back(plot.title);
      Plot merged = plot;
      merged.curves.clear();
      for (std::size_t r = 0; r < runs.size(); ++r)
        for (const auto& other : runs[r]->curves) {
          if (other.title != plot.title) continue;
          for (std::size_t c = 0; c < other.curves.size(); ++c) {
            auto curve = other.curves[c];
            const bool is_single = other.curves.size() == 1;
            curve.label = runs[r]->title + (is_single ? "" : " " + curve.label);
            // One colour for each run; of several components, for each component, and dashes for each run.
            curve.style = static_cast<int>(is_single ? r : c + r * kNumColors);
            merged.curves.push_back(std::move(curve));
          }
        }
      html += make_figure(merged);
    }
  overlay.add_panel("overlay", "Time histories", html + "</div>\n");
  overlay.data = "{}";
  return overlay;
}

}  // namespace bough::report
