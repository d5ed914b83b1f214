#include "vmech/apps/view/view_page.h"

#include <string_view>
#include <utility>

#include "vmech/apps/view/scene.h"

// Files of page/ and what is made of them, embedded by embedded.S.
extern "C" {
extern const char vmech_three[], vmech_three_end[];
extern const char vmech_page_script[], vmech_page_script_end[];
extern const char vmech_page_style[], vmech_page_style_end[];
extern const char vmech_page_html[], vmech_page_html_end[];
}

namespace vmech {
namespace {

std::string_view Between(const char* begin, const char* end) {
  return {begin, static_cast<size_t>(end - begin)};
}

std::string StyleElement() {
  return "<style>\n" + std::string(Between(vmech_page_style, vmech_page_style_end)) + "</style>\n";
}

/// Of HTML and XML alike.
std::string ScriptElement(std::string_view script) {
  return "<script>//<![CDATA[\n" + std::string(script) + "\n//]]></script>\n";
}

std::string SceneElement(const std::string& json) {
  return "<script type=\"application/json\" id=\"vmech-scene\">" + json + "</script>\n";
}

void Replace(std::string_view mark, std::string_view text, std::string* page) {
  if (const size_t at = page->find(mark); at != std::string::npos) {
    page->replace(at, mark.size(), text);
  }
}

}  // namespace

std::string ViewPage(const std::string& title, const std::string& scene_json) {
  std::string page(Between(vmech_page_html, vmech_page_html_end));
  Replace("<title>vmech</title>", "<title>" + html::EscapeText(title) + "</title>", &page);
  Replace("<!--vmech:style-->", StyleElement(), &page);
  Replace("<!--vmech:scene-->", SceneElement(scene_json), &page);
  Replace("<!--vmech:three-->", ScriptElement(Between(vmech_three, vmech_three_end)), &page);
  Replace("<!--vmech:script-->", ScriptElement(Between(vmech_page_script, vmech_page_script_end)),
          &page);
  return page;
}

std::string MechanismPage(const KinematicTree& assembled, std::vector<std::string> meshes,
                          std::string_view version, std::string_view session,
                          std::string_view parameters) {
  Scene scene;
  scene.title = assembled.mechanism.name;
  scene.version = version;
  scene.tree = &assembled;
  scene.meshes = std::move(meshes);
  scene.session = session;
  scene.parameters = parameters;
  return ViewPage(scene.title, SceneJson(scene));
}

html::Markup ViewPlace() {
  return html::Markup::Raw(StyleElement() + "<div class=\"vmech-view\" id=\"vmech-view\"></div>\n");
}

html::Markup ViewScripts(const std::string& scene_json) {
  return html::Markup::Raw(SceneElement(scene_json) +
                           ScriptElement(Between(vmech_three, vmech_three_end)) +
                           ScriptElement(Between(vmech_page_script, vmech_page_script_end)));
}

}  // namespace vmech
