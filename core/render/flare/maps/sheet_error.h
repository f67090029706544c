// sheet_error.h -- how far the maps of ghosts are off, by exact rays.
#pragma once
#include "render/flare/flare_tiles.h"
#include "render/flare/maps/flare_sheets.h"

namespace dg {

struct SheetErrors {
    double all;                     // FlareSheets::error()
    std::vector<double> of_sheet;   // the same of each by itself
};
/// `tiles`: the light of the maps.
SheetErrors sheet_errors(const FlareSheets& sheets, const FlareTiles& tiles, const RenderSettings& settings);

}  // namespace dg
