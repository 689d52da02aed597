#include "report/vtk/svg_device.h"

#include <fmt/format.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPen.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>
#include <vtkXMLDataElement.h>

#include <cmath>
#include <string>

namespace heatsoak::report {

vtkStandardNewMacro(SvgDevice);

void SvgDevice::DrawString(float* point, const vtkStdString& text) {
  const float y_px = this->CanvasHeight - point[1];
  // The outline keeps text readable on curves. It is drawn first, because not all viewers support paint-order.
  if (this->TextProp->GetShadow() != 0) {
    add_text(point[0], y_px, text, true);
  }
  add_text(point[0], y_px, text, false);
}

void SvgDevice::DrawPoly(float* points, int count, unsigned char* colors, int components) {
  if (this->Pen->GetLineType() != vtkPen::NO_PEN) {
    Superclass::DrawPoly(points, count, colors, components);
  }
}

void SvgDevice::add_text(float x_px, float y_px, const vtkStdString& text, bool is_rim) {
  const double size_px = this->TextProp->GetFontSize();
  // Viewers disagree on dominant-baseline; a shift by the usual cap height is the same in all of them.
  constexpr double kCapitalHeight = 0.72;
  const int vertical = this->TextProp->GetVerticalJustification();
  const double shift = vertical == VTK_TEXT_TOP ? 1.0 : vertical == VTK_TEXT_CENTERED ? 0.5 : 0.0;
  const int horizontal = this->TextProp->GetJustification();
  const char* anchor = horizontal == VTK_TEXT_RIGHT ? "end" : horizontal == VTK_TEXT_CENTERED ? "middle" : nullptr;

  vtkNew<vtkXMLDataElement> element;
  element->SetName("text");
  element->SetAttribute("x", fmt::format("{:.6g}", x_px).c_str());
  element->SetAttribute("y", fmt::format("{:.6g}", y_px + shift * kCapitalHeight * size_px).c_str());
  if (const double turn_deg = this->TextProp->GetOrientation(); turn_deg != 0.0) {
    element->SetAttribute("transform", fmt::format("rotate({:g},{:.6g},{:.6g})", -turn_deg, x_px, y_px).c_str());
  }
  element->SetAttribute("font-size", fmt::format("{:g}", size_px).c_str());
  if (this->TextProp->GetBold() != 0) {
    element->SetAttribute("font-weight", "bold");
  }
  if (anchor != nullptr) {
    element->SetAttribute("text-anchor", anchor);
  }
  const auto channel = [this](int i) { return std::lround(this->TextProp->GetColor()[i] * 255.0); };
  const std::string color = fmt::format("#{:02x}{:02x}{:02x}", channel(0), channel(1), channel(2));
  element->SetAttribute("fill", is_rim ? "#ffffff" : color.c_str());
  if (is_rim) {
    element->SetAttribute("stroke", "#ffffff");
    element->SetAttribute("stroke-width", "3");
    element->SetAttribute("stroke-linejoin", "round");
  }
  element->SetCharacterData(text.c_str(), static_cast<int>(text.size()));
  this->ActiveNode->AddNestedElement(element);
}

}  // namespace heatsoak::report
