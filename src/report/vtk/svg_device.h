// VTK's SVG device with corrected text.
#pragma once

#include <vtkSVGContextDevice2D.h>

namespace heatsoak::report {

/// Corrects three faults of VTK 9.1. Text: VTK writes glyph outlines (large, not searchable), or <text> with attribute values that SVG does
/// not define ("right", "top"), sizes in pt and the wrong rotation. Clipping: VTK uses wrong coordinates for the rectangle; clipping is
/// switched off because nothing needs it. Lines without a pen: VTK writes them in black with dashes of length 0, which some viewers show as
/// dots.
class SvgDevice : public vtkSVGContextDevice2D {
 public:
  static SvgDevice* New();
  vtkTypeMacro(SvgDevice, vtkSVGContextDevice2D)

      /// The property "bottom" means the baseline; "shadow" means a white outline.
      void DrawString(float* point, const vtkStdString& text) override;
  using vtkSVGContextDevice2D::DrawString;

  void DrawPoly(float* points, int count, unsigned char* colors, int components) override;

  void SetClipping(int*) override {}
  void EnableClipping(bool) override {}

 protected:
  SvgDevice() = default;

 private:
  void add_text(float x_px, float y_px, const vtkStdString& text, bool is_rim);
};

}  // namespace heatsoak::report
