// VTK's SVG painter with text that viewers draw where it belongs.
#pragma once

#include <vtkSVGContextDevice2D.h>

namespace heatsoak {

/// Two things of VTK 9.1 are mended. Text: VTK writes either glyph outlines (large, not searchable) or
/// <text> with attribute values that SVG does not know ("right", "top"), sizes in pt and turned the wrong
/// way. Clipping: VTK gives the rectangle in the wrong coordinates; nothing here needs any.
class SvgDevice : public vtkSVGContextDevice2D {
 public:
  static SvgDevice* New();
  vtkTypeMacro(SvgDevice, vtkSVGContextDevice2D)

      /// A text property's "bottom" is the base line; its "shadow" is drawn as a white rim.
      void DrawString(float* point, const vtkStdString& text) override;
  using vtkSVGContextDevice2D::DrawString;

  void SetClipping(int*) override {}
  void EnableClipping(bool) override {}

 protected:
  SvgDevice() = default;

 private:
  void add_text(float x_px, float y_px, const vtkStdString& text, bool is_rim);
};

}  // namespace heatsoak
