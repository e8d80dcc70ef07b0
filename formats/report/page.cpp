#include "formats/report/page.hpp"

#include "base/xml_text.hpp"
#include "formats/report/html.hpp"
#include "formats/report/web_text.hpp"

namespace bough::report {

namespace {

const char* get_word(Verdict verdict) {
  switch (verdict) {
    case Verdict::Good:
      return "ok";
    case Verdict::Warning:
      return "look";
    case Verdict::Bad:
      return "bad";
    case Verdict::None:
      break;
  }
  return "told";
}

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

std::string make_head(const Chapter& chapter) {
  std::string html = make_facts(chapter.facts);
  if (!chapter.settings.empty())
    html += "<details><summary>Settings</summary>\n" + make_facts(chapter.settings) + "</details>\n";
  if (chapter.checks.empty()) return html;
  html += "<div class=\"scroll\"><table class=\"health\"><caption>Health</caption>\n<tbody>\n";
  for (const auto& check : chapter.checks)
    html += "<tr><td>" + make_badge(check.verdict) + "</td><td class=\"text\">" + escape_xml(check.what) + "</td><td>" +
            escape_xml(check.value) + "</td><td class=\"text\">" + escape_xml(check.note) + "</td></tr>\n";
  return html + "</tbody></table></div>\n";
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
    html += "<section class=\"chapter\" id=\"" + id + "\" data-kind=\"" + escape_xml(chapter.kind) + "\">\n<h2>" +
            escape_xml(chapter.title) + " <small>" + escape_xml(chapter.kind) + "</small> " +
            make_badge(chapter.get_verdict()) + "</h2>\n" + make_head(chapter);
    for (const auto& panel : chapter.panels)
      html += "<section class=\"panel\" id=\"" + id + "-" + panel.id + "\">\n<h3>" + escape_xml(panel.title) +
              "</h3>\n" + panel.html + "</section>\n";
    if (!chapter.data.empty())
      html += "<script type=\"application/json\" class=\"data\">" + shield(chapter.data) + "</script>\n";
    html += "</section>\n";
  }
  html += "</main>\n<script type=\"module\">";
  html += get_script();
  html += "</script>\n</body>\n</html>\n";
  return html;
}

}  // namespace bough::report
