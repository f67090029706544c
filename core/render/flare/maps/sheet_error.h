// sheet_error.h -- errors of ghost maps, measured with exact rays.
#pragma once
#include "render/flare/flare_tiles.h"
#include "render/flare/maps/flare_sheets.h"

namespace dg {

struct SheetErrors {
    double all;                     // FlareSheets::error()
    std::vector<double> of_sheet;   // error of each map
};
/// `tiles`: light of the maps.
SheetErrors sheet_errors(const FlareSheets& sheets, const FlareTiles& tiles, const RenderSettings& settings);

}  // namespace dg
