// Draws a page layout with VTK's charts. It needs neither a display nor an OpenGL context: the window that the scene requires is never
// rendered, because the scene is painted by the SVG device.
#include <vtkAutoInit.h>
#include <vtkAxis.h>
#include <vtkBrush.h>
#include <vtkChartXY.h>
#include <vtkContext2D.h>
#include <vtkContextScene.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPen.h>
#include <vtkPlotArea.h>
#include <vtkPlotLine.h>
#include <vtkRenderer.h>
#include <vtkStdString.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>

#include <algorithm>
#include <array>
#include <exception>
#include <initializer_list>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>

#include "report/chart_plugin.h"
#include "report/vtk/page.h"
#include "report/vtk/reduce.h"
#include "report/vtk/svg_device.h"

VTK_MODULE_INIT(vtkRenderingOpenGL2)
VTK_MODULE_INIT(vtkRenderingFreeType)

namespace heatsoak::report {
namespace {

using Color = std::array<unsigned char, 3>;

/// Palette of Okabe and Ito. Vermilion comes late because limits are red, yellow last because the paper is white.
constexpr std::array<Color, 8> kPalette{{{0x00, 0x72, 0xB2},
                                         {0xE6, 0x9F, 0x00},
                                         {0x00, 0x9E, 0x73},
                                         {0xCC, 0x79, 0xA7},
                                         {0x56, 0xB4, 0xE9},
                                         {0x00, 0x00, 0x00},
                                         {0xD5, 0x5E, 0x00},
                                         {0xF0, 0xE4, 0x42}}};
constexpr unsigned char kBandOpacity = 51;  // 20 %

Color palette_color(std::optional<int> index) {
  return index ? kPalette[static_cast<unsigned>(*index) % kPalette.size()] : std::to_array(kLimitColor);
}

void set_pen(vtkPen* pen, const Color& color, double width_px, bool is_dashed) {
  pen->SetColor(color[0], color[1], color[2]);
  pen->SetWidth(static_cast<float>(width_px));
  pen->SetLineType(is_dashed ? vtkPen::DASH_LINE : vtkPen::SOLID_LINE);
}

void add_column(vtkTable* table, const char* name, const std::vector<double>& values) {
  vtkNew<vtkFloatArray> column;
  column->SetName(name);
  for (const double value : values) {
    column->InsertNextValue(static_cast<float>(value));
  }
  table->AddColumn(column);
}

void add_line(vtkChartXY* chart, const std::vector<CurvePoint>& points, const Color& color, double width_px, bool is_dashed) {
  std::vector<double> x_px, y_px;
  for (const CurvePoint& point : points) {
    x_px.push_back(point.x_px);
    y_px.push_back(point.y_px);
  }
  vtkNew<vtkTable> table;
  add_column(table, "x", x_px);
  add_column(table, "y", y_px);
  vtkNew<vtkPlotLine> line;
  line->SetInputData(table, 0, 1);
  set_pen(line->GetPen(), color, width_px, is_dashed);
  chart->AddPlot(line);
}

/// Draws one unbroken piece of a band. VTK would write "nan" for a band with gaps.
void add_area(vtkChartXY* chart, const std::vector<BandPoint>& points, const Color& color, unsigned char opacity) {
  std::vector<double> x_px, low_px, high_px;
  for (const BandPoint& point : points) {
    x_px.push_back(point.x_px);
    low_px.push_back(point.low_px);
    high_px.push_back(point.high_px);
  }
  if (points.size() == 2) {
    // vtkPlotArea does not draw an area of two points.
    x_px.insert(x_px.begin() + 1, 0.5 * (x_px.front() + x_px.back()));
    low_px.insert(low_px.begin() + 1, 0.5 * (low_px.front() + low_px.back()));
    high_px.insert(high_px.begin() + 1, 0.5 * (high_px.front() + high_px.back()));
  }
  vtkNew<vtkTable> table;
  add_column(table, "x", x_px);
  add_column(table, "low", low_px);
  add_column(table, "high", high_px);
  vtkNew<vtkPlotArea> area;
  area->SetInputData(table);
  area->SetInputArray(0, "x");
  area->SetInputArray(1, "low");
  area->SetInputArray(2, "high");
  area->GetBrush()->SetColor(color[0], color[1], color[2], opacity);
  chart->AddPlot(area);
}

/// Draws ripple as a line along its maxima and a thin one along its minima, the rest as a line. An area between them would look like a
/// band.
void add_curve(vtkChartXY* chart, const RippledPiece& piece, const Color& color, bool is_dashed) {
  for (const std::vector<BandPoint>& ripple : piece.envelopes) {
    for (const auto& [edge, width_px] : {std::pair{&BandPoint::low_px, kMinimaWidth_px}, std::pair{&BandPoint::high_px, kCurveWidth_px}}) {
      std::vector<CurvePoint> line;
      std::ranges::transform(ripple, std::back_inserter(line), [edge = edge](const BandPoint& at) {
        return CurvePoint{at.x_px, at.*edge};
      });
      add_line(chart, line, color, width_px, is_dashed);
    }
  }
  for (const std::vector<CurvePoint>& line : piece.lines) {
    add_line(chart, line, color, kCurveWidth_px, is_dashed);
  }
}

/// Draws a bar with a cap at each end and a square at its mark.
void add_bar(vtkChartXY* chart, const RangeBar& bar) {
  const Color color = palette_color(bar.color_index);
  const auto across = [&](double y_px, double length_px, double width_px) {
    add_line(chart, {{bar.x_px - 0.5 * length_px, y_px}, {bar.x_px + 0.5 * length_px, y_px}}, color, width_px, false);
  };
  add_line(chart, {{bar.x_px, bar.low_px}, {bar.x_px, bar.high_px}}, color, kCurveWidth_px, false);
  across(bar.low_px, kRangeCap_px, kCurveWidth_px);
  across(bar.high_px, kRangeCap_px, kCurveWidth_px);
  across(bar.mark_px, kMarker_px, kMarker_px);
}

/// The axis counts pixels, so that VTK's transform of the plots is the identity. An SVG matrix with unequal scales would distort pens and
/// dashes.
void set_axis(vtkAxis* axis, const AxisScale& scale, const std::vector<AxisTick>& axis_ticks) {
  vtkNew<vtkDoubleArray> positions;
  vtkNew<vtkStringArray> labels;
  for (const AxisTick& tick : axis_ticks) {
    positions->InsertNextValue(scale.to_px(tick.value));
    labels->InsertNextValue(tick.label);
  }
  axis->SetBehavior(vtkAxis::CUSTOM);
  axis->SetRange(scale.low_px, scale.high_px);
  axis->SetCustomTickPositions(positions, labels);
  axis->SetTitle("");
  axis->GetLabelProperties()->SetFontSize(kTickStyle.size_px);
  axis->GetLabelProperties()->SetColor(kTickStyle.color[0] / 255.0, kTickStyle.color[1] / 255.0, kTickStyle.color[2] / 255.0);
  axis->GetPen()->SetColor(0x77, 0x77, 0x77);
  axis->GetGridPen()->SetColor(0xE4, 0xE4, 0xE4);
}

void add_panel(vtkContextScene* scene, const ChartPanel& panel, const PanelPlace& place) {
  vtkNew<vtkChartXY> chart;
  const AxisScale& across = place.horizontal;
  const AxisScale& up = place.vertical;
  chart->SetLayoutStrategy(vtkChart::AXES_TO_RECT);
  chart->SetSize(vtkRectf(static_cast<float>(across.low_px), static_cast<float>(up.low_px),
                          static_cast<float>(across.high_px - across.low_px), static_cast<float>(up.high_px - up.low_px)));
  chart->SetBackgroundBrush(nullptr);
  chart->SetRenderEmpty(true);
  chart->SetAutoAxes(false);
  set_axis(chart->GetAxis(vtkAxis::BOTTOM), across, place.x_ticks);
  set_axis(chart->GetAxis(vtkAxis::LEFT), up, place.y_ticks);
  for (const ChartBand& band : panel.bands) {
    for (const std::vector<BandPoint>& piece : reduce(band, across, up)) {
      add_area(chart, piece, palette_color(band.color_index), kBandOpacity);
    }
  }
  for (const ChartCurve& curve : panel.curves) {
    if (curve.dots) {
      for (const std::vector<CurvePoint>& piece : markers(curve, across, up, kMarker_px)) {
        add_line(chart, piece, palette_color(curve.color_index), kMarker_px, false);
      }
      continue;
    }
    for (const std::vector<CurvePoint>& piece : reduce(curve, across, up)) {
      add_curve(chart, curve.has_ripple ? without_ripple(piece) : RippledPiece{{piece}, {}}, palette_color(curve.color_index),
                curve.dashed);
    }
  }
  for (const RangeBar& bar : place.bars) {
    add_bar(chart, bar);
  }
  for (const ChartLevel& level : panel.levels) {
    if (level.y < up.range.low || level.y > up.range.high) {
      continue;
    }
    const ChartCurve line{.name = "", .x = {across.range.low, across.range.high}, .y = {level.y, level.y}};
    for (const std::vector<CurvePoint>& piece : reduce(line, across, up)) {
      add_line(chart, piece, std::to_array(kLimitColor), 1.5F, true);
    }
  }
  scene->AddItem(chart);
}

/// Titles, labels, names of limits and the legend. Drawn here, because vtkChart centres its title and has one legend per chart.
class Lettering : public vtkContextItem {
 public:
  static Lettering* New();
  vtkTypeMacro(Lettering, vtkContextItem)

      void set_page(const Page* page) {
    page_ = page;
  }

  bool Paint(vtkContext2D* painter) override {
    for (const LegendSwatch& swatch : page_->swatches) {
      paint(painter, swatch);
    }
    for (const PlacedText& text : page_->texts) {
      paint(painter, text);
    }
    return true;
  }

 private:
  static void paint(vtkContext2D* painter, const LegendSwatch& swatch) {
    const Color color = palette_color(swatch.color_index);
    const auto left_px = static_cast<float>(swatch.x_px);
    const auto right_px = static_cast<float>(swatch.x_px + kSwatchWidth_px);
    const auto y_px = static_cast<float>(swatch.y_px);
    if (swatch.is_band) {
      // A quad strip, because VTK outlines quads and polygons.
      float corners[] = {left_px, y_px - 5, left_px, y_px + 5, right_px, y_px - 5, right_px, y_px + 5};
      painter->GetBrush()->SetColor(color[0], color[1], color[2], kBandOpacity);
      painter->DrawQuadStrip(corners, 4);
    } else if (swatch.is_dots) {
      const float middle_px = 0.5F * (left_px + right_px);
      const float half_px = 0.5F * static_cast<float>(kMarker_px);
      set_pen(painter->GetPen(), color, kMarker_px, false);
      painter->DrawLine(middle_px - half_px, y_px, middle_px + half_px, y_px);
    } else {
      set_pen(painter->GetPen(), color, kCurveWidth_px, swatch.is_dashed);
      painter->DrawLine(left_px, y_px, right_px, y_px);
    }
  }

  /// Paints the white rectangle behind a text that is not upright.
  static void paint_plate(vtkContext2D* painter, const PlacedText& text) {
    const double width_px = text_width_px(text.text, text.style);
    const double behind = text.anchor == Anchor::left ? 0.0 : text.anchor == Anchor::middle ? 0.5 : 1.0;
    const auto left_px = static_cast<float>(text.x_px - behind * width_px);
    const auto right_px = left_px + static_cast<float>(width_px);
    const auto bottom_px = static_cast<float>(text.y_px - kDescent_ratio * text.style.size_px);
    const auto top_px = static_cast<float>(text.y_px + kAscent_ratio * text.style.size_px);
    float corners[] = {left_px, bottom_px, left_px, top_px, right_px, bottom_px, right_px, top_px};
    painter->GetBrush()->SetColor(255, 255, 255, 255);
    painter->DrawQuadStrip(corners, 4);
  }

  static void paint(vtkContext2D* painter, const PlacedText& text) {
    vtkTextProperty* property = painter->GetTextProp();
    property->SetFontSize(text.style.size_px);
    property->SetBold(text.style.is_bold);
    property->SetColor(text.style.color[0] / 255.0, text.style.color[1] / 255.0, text.style.color[2] / 255.0);
    property->SetJustification(text.anchor == Anchor::left     ? VTK_TEXT_LEFT
                               : text.anchor == Anchor::middle ? VTK_TEXT_CENTERED
                                                               : VTK_TEXT_RIGHT);
    property->SetVerticalJustificationToBottom();
    property->SetOrientation(text.is_upright ? 90.0 : 0.0);
    if (text.ground == Ground::plate) {
      paint_plate(painter, text);
    }
    property->SetShadow(text.ground == Ground::rim);
    painter->DrawString(static_cast<float>(text.x_px), static_cast<float>(text.y_px), text.text);
    property->SetShadow(false);
  }

  const Page* page_ = nullptr;
};
vtkStandardNewMacro(Lettering);

using Attributes = std::initializer_list<std::pair<const char*, std::string>>;

vtkNew<vtkXMLDataElement> element(const char* name, Attributes attributes) {
  vtkNew<vtkXMLDataElement> result;
  result->SetName(name);
  result->SetAttributeEncoding(VTK_ENCODING_UTF_8);
  for (const auto& [key, value] : attributes) {
    result->SetAttribute(key, value.c_str());
  }
  return result;
}

/// Paints the scene into `group`.
void paint(vtkContextScene* scene, const Page& page, vtkXMLDataElement* group, vtkXMLDataElement* definitions) {
  vtkNew<vtkGenericOpenGLRenderWindow> window;
  window->SetSize(page.width_px, page.height_px);
  window->SetDPI(72);  // one point is one pixel
  vtkNew<vtkRenderer> renderer;
  window->AddRenderer(renderer);
  scene->SetRenderer(renderer);
  scene->SetGeometry(page.width_px, page.height_px);
  vtkNew<SvgDevice> device;
  device->SetSVGContext(group, definitions);
  device->Begin(renderer);
  vtkNew<vtkContext2D> painter;
  painter->Begin(device);
  scene->Paint(painter);
  painter->End();
  device->End();
  scene->SetRenderer(nullptr);
}

std::string draw(const Chart& chart) {
  const Page page = lay_out(chart);
  vtkNew<vtkContextScene> scene;
  for (std::size_t i = 0; i < chart.panels.size(); ++i) {
    add_panel(scene, chart.panels[i], page.panels[i]);
  }
  vtkNew<Lettering> lettering;
  lettering->set_page(&page);
  scene->AddItem(lettering);

  const std::string width = std::to_string(page.width_px);
  const std::string height = std::to_string(page.height_px);
  const auto root = element("svg", {{"xmlns", "http://www.w3.org/2000/svg"},
                                    {"width", width},
                                    {"height", height},
                                    {"viewBox", "0 0 " + width + " " + height},
                                    {"role", "img"},
                                    {"aria-label", printable(chart.title)}});
  const auto paper = element("rect", {{"width", width}, {"height", height}, {"fill", "#ffffff"}});
  // Shifted by half a pixel: a line on a whole pixel then fills one row of pixels instead of blurring over two.
  const auto group = element("g", {{"transform", "translate(0.5,0.5)"},
                                   {"fill", "none"},
                                   {"stroke-linejoin", "round"},
                                   {"font-family", "sans-serif"},
                                   {"xml:space", "preserve"}});
  const auto definitions = element("defs", {});
  paint(scene, page, group, definitions);
  root->AddNestedElement(paper);
  root->AddNestedElement(group);
  std::ostringstream text;
  vtkIndent indent;
  vtkXMLUtilities::FlattenElement(root, text, &indent);
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + text.str();
}

}  // namespace
}  // namespace heatsoak::report

extern "C" __attribute__((visibility("default"))) bool heatsoak_draw_chart(const heatsoak::report::Chart* chart, std::string* text,
                                                                           std::size_t layout) {
  if (layout != heatsoak::report::kChartLayout) {
    *text = std::string(heatsoak::report::kChartPluginFile) + " is of another build than the program; build or install both again";
    return false;
  }
  try {
    *text = heatsoak::report::draw(*chart);
    return true;
  } catch (const std::exception& problem) {
    *text = problem.what();
    return false;
  }
}
