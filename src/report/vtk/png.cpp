// Converts a picture to PNG with librsvg and cairo, because VTK needs a display for that.
#include <cairo.h>
#include <librsvg/rsvg.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "report/chart_plugin.h"

namespace heatsoak::report {
namespace {

/// Pixels of the PNG per pixel of the SVG, so that small text stays sharp.
constexpr double kScale = 2.0;

template <class T, auto release>
using Owned = std::unique_ptr<T, decltype([](T* object) { release(object); })>;

cairo_status_t append(void* target, const unsigned char* bytes, unsigned int count) {
  static_cast<std::string*>(target)->append(reinterpret_cast<const char*>(bytes), count);
  return CAIRO_STATUS_SUCCESS;
}

std::string png_of(const std::string& svg) {
  GError* problem = nullptr;
  const Owned<RsvgHandle, g_object_unref> handle(
      rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(svg.data()), svg.size(), &problem));
  const auto throw_problem = [&problem] {
    const Owned<GError, g_error_free> owned(problem);
    throw std::runtime_error(owned ? owned->message : "the picture cannot be read");
  };
  if (!handle) {
    throw_problem();
  }
  double width_px = 0.0;
  double height_px = 0.0;
  if (!rsvg_handle_get_intrinsic_size_in_pixels(handle.get(), &width_px, &height_px)) {
    throw std::runtime_error("the picture has no size in pixels");
  }
  const Owned<cairo_surface_t, cairo_surface_destroy> surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(kScale * width_px), static_cast<int>(kScale * height_px)));
  const Owned<cairo_t, cairo_destroy> painter(cairo_create(surface.get()));
  const RsvgRectangle page{0.0, 0.0, kScale * width_px, kScale * height_px};
  if (!rsvg_handle_render_document(handle.get(), painter.get(), &page, &problem)) {
    throw_problem();
  }
  std::string png;
  if (cairo_surface_write_to_png_stream(surface.get(), append, &png) != CAIRO_STATUS_SUCCESS) {
    throw std::runtime_error("the picture cannot be written as PNG");
  }
  return png;
}

}  // namespace
}  // namespace heatsoak::report

extern "C" __attribute__((visibility("default"))) bool heatsoak_svg_to_png(const std::string* svg, std::string* png) {
  try {
    *png = heatsoak::report::png_of(*svg);
    return true;
  } catch (const std::exception& problem) {
    *png = problem.what();
    return false;
  }
}
