#include "tools/cli/diff_page.hpp"

#include <fmt/format.h>

extern "C" {
#include <libavutil/base64.h>
}

#include "core/error.hpp"
#include "core/markup.hpp"
#include "core/version.hpp"
#include "film/image/png.hpp"
#include "tools/cli/diff_report.hpp"

namespace weft::cli {
namespace {

using compare::FileComparison;

// Limit on the size of all pictures of a page [bytes]; a browser opens such a page in some seconds. Further pairs are
// shown without pictures.
constexpr std::size_t kMaxPagePictureBytes = 100'000'000;

// Radio buttons select the view of a pair. The views are in the same place, so that arrow keys switch between reference
// and test without moving the picture.
constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --text: #1b2227; --ground: #f4f6f7; --panel: #fff; --muted: #56626b; --line: #d9dfe3; --accent: #0b6579; }
@media (prefers-color-scheme: dark) { :root { --text: #e2e8ec; --ground: #12161a; --panel: #1a2025; --muted: #9aa8b2; --line: #2d363d; --accent: #63c3d8; } }
body { margin: 0 auto; padding: 16px 20px 60px; max-width: 1900px; background: var(--ground); color: var(--text); font: 15px/1.5 system-ui, sans-serif; }
h1 { font-size: 22px; } h2 { font-size: 17px; margin: 0; overflow-wrap: anywhere; }
.pair { margin: 14px 0; padding: 12px 14px; background: var(--panel); border: 1px solid var(--line); border-radius: 6px; }
p { margin: 4px 0 8px; overflow-wrap: anywhere; } .muted, figcaption { color: var(--muted); font-size: 13px; }
label { display: inline-block; padding: 4px 14px 4px 2px; cursor: pointer; } input { accent-color: var(--accent); }
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(300px, 100%), 1fr)); gap: 8px; }
figure { margin: 0; min-width: 0; } img { display: block; width: 100%; image-rendering: auto; background: #000; }
.one-before:checked ~ .pictures figure:not(.before), .one-after:checked ~ .pictures figure:not(.after),
.one-difference:checked ~ .pictures figure:not(.difference) { display: none; }
input:not(.all):checked ~ .pictures { grid-template-columns: 1fr; }
ul { columns: 3 260px; overflow-wrap: anywhere; }
)";

std::string base64(std::string_view bytes) {
  std::string text(AV_BASE64_SIZE(bytes.size()), '\0');
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  if (av_base64_encode(text.data(), static_cast<int>(text.size()), data, static_cast<int>(bytes.size())) == nullptr)
    throw Error(ExitCode::output_failed, "a picture of {} bytes is too large for the page", bytes.size());
  text.pop_back();  // the terminating zero
  return text;
}

// The picture of a file in a pair that was not compared (one file is missing, or sizes differ); empty if unreadable.
image::Image picture_of(const std::filesystem::path& file) {
  try {
    return compare::first_picture(file);
  } catch (const Error&) {
    return {};
  }
}

}  // namespace

void DiffPage::add_figure(const char* kind, const std::string& caption, const image::Image& picture) {
  if (picture.width == 0) return;
  const std::string bytes = base64(image::png_bytes(picture));
  picture_bytes_ += bytes.size();
  sections_ += fmt::format(
      "<figure class=\"{0}\"><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}: "
      "{2}</figcaption></figure>\n",
      kind, bytes, markup_text(caption));
}

void DiffPage::add(const FileComparison& result, const std::string& description) {
  if (result.good()) {
    good_ += fmt::format("<li>{}</li>\n", markup_text(description));
    return;
  }
  ++differing_;
  sections_ += fmt::format("<section class=\"pair\">\n<h2>{}</h2>\n<p>{}</p>\n", markup_text(result.name),
                           markup_text(description.substr(std::min(description.size(), result.name.size() + 2))));
  const bool compared = result.frames > 0;
  if (picture_bytes_ > kMaxPagePictureBytes) {
    sections_ += "<p class=\"muted\">Without pictures: the page holds 100 MB of them already.</p>\n";
  } else {
    const auto view = [&](const char* kind, const char* text, const char* checked = "") {
      return fmt::format(
          "<input type=\"radio\" name=\"pair-{0}\" id=\"pair-{0}-{1}\" class=\"{1}\"{3}>"
          "<label for=\"pair-{0}-{1}\">{2}</label>\n",
          differing_, kind, text, checked);
    };
    if (compared)
      sections_ += view("all", "side by side", " checked") + view("one-before", "before") + view("one-after", "after") +
                   view("one-difference", "difference");
    sections_ += "<div class=\"pictures\">\n";
    add_figure("before", result.reference.string(), compared ? result.reference_picture : picture_of(result.reference));
    add_figure("after", result.test.string(), compared ? result.test_picture : picture_of(result.test));
    if (compared) add_figure("difference", "FLIP, dark where both look the same", compare::heat_map(result.worst.flip));
    sections_ += "</div>\n";
  }
  sections_ += "</section>\n";
}

std::string DiffPage::html(const std::string& title) const {
  const std::string good = good_.empty() ? "" : fmt::format("<h2>As their references</h2>\n<ul>\n{}</ul>\n", good_);
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"generator\" content=\"weft diff {}\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "style-src 'unsafe-inline'\">\n<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n<main>\n"
      "<h1>{}</h1>\n{}{}</main>\n</body>\n</html>\n",
      kVersion, markup_text(title), kStyle, markup_text(title), sections_, good);
}

}  // namespace weft::cli
