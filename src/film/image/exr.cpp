#include "film/image/exr.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>
#include <exception>

#include "core/error.hpp"
#include "core/input_file.hpp"
#include "core/temporary_file.hpp"

namespace weft::image {
namespace {

Imf::Header header_of(const Layers& layers, const Metadata& metadata) {
  Imf::Header header(layers.width, layers.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::addChromaticities(header, Imf::Chromaticities());  // by default those of Rec. 709
  for (const auto& [key, text] : metadata) header.insert(key, Imf::StringAttribute(text));
  for (const Layers::Channel& channel : layers.channels)
    header.channels().insert(channel.name, Imf::Channel(channel.half ? Imf::HALF : Imf::FLOAT));
  return header;
}

}  // namespace

void write_exr(const std::filesystem::path& file, const Layers& layers, const Metadata& metadata) {
  const std::size_t pixels = static_cast<std::size_t>(layers.width) * static_cast<std::size_t>(layers.height);
  for (const Layers::Channel& channel : layers.channels) {
    if (channel.values.size() == pixels) continue;
    throw Error(ExitCode::output_failed, "{}: expected {}x{} values of {}, got {}", file.string(), layers.width,
                layers.height, channel.name, channel.values.size());
  }
  TemporaryFile temporary(file);
  try {
    Imf::OutputFile out(temporary.path().c_str(), header_of(layers, metadata));
    Imf::FrameBuffer rows;
    std::vector<std::vector<half>> halves;
    halves.reserve(layers.channels.size());
    for (const Layers::Channel& channel : layers.channels) {
      const auto insert = [&](Imf::PixelType type, const auto* values) {
        // OpenEXR takes char* also for data that it only reads.
        auto* bytes = const_cast<char*>(reinterpret_cast<const char*>(values));
        rows.insert(channel.name, Imf::Slice(type, bytes, sizeof(*values), sizeof(*values) * layers.width));
      };
      if (channel.half) {
        insert(Imf::HALF, halves.emplace_back(channel.values.begin(), channel.values.end()).data());
      } else {
        insert(Imf::FLOAT, channel.values.data());
      }
    }
    out.setFrameBuffer(rows);
    out.writePixels(layers.height);
  } catch (const std::exception& error) {
    throw Error(ExitCode::output_failed, "{}: {}", file.string(), error.what());
  }
  temporary.commit();
}

ExrHeader read_exr_header(const std::filesystem::path& file) {
  try {
    check_is_file(file);
    Imf::InputFile in(file.c_str());
    const Imath::Box2i& area = in.header().dataWindow();
    ExrHeader found{area.max.x - area.min.x + 1, area.max.y - area.min.y + 1, {}};
    // Reads the last line of pixels to detect a truncated file, because the table of line offsets does not show this.
    const int end = in.header().lineOrder() == Imf::DECREASING_Y ? area.min.y : area.max.y;
    std::vector<float> line(static_cast<std::size_t>(found.width));
    Imf::FrameBuffer last;
    for (auto channel = in.header().channels().begin(); channel != in.header().channels().end(); ++channel)
      last.insert(channel.name(),
                  Imf::Slice::Make(Imf::FLOAT, line.data(), Imath::V2i(area.min.x, end), found.width, 1));
    in.setFrameBuffer(last);
    in.readPixels(end);
    for (auto entry = in.header().begin(); entry != in.header().end(); ++entry)
      if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&entry.attribute()))
        found.metadata[entry.name()] = text->value();
    return found;
  } catch (const std::exception& error) {
    throw Error(ExitCode::asset_unreadable, "{}: {}", file.string(), error.what());
  }
}

}  // namespace weft::image
