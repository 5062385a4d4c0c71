#pragma once

#include "manoscope/io/reader.hpp"

namespace manoscope::io {

// One reader a format, each defined in the file of that format; registry.cpp lists them.
const Reader& alicona_al3d_reader();
const Reader& bruker_opdx_reader();
const Reader& digital_surf_reader();
const Reader& frt_microprof_reader();
const Reader& gsf_reader();
const Reader& gwy_reader();
const Reader& hdf5_reader();
const Reader& keyence_vk_reader();
const Reader& matlab_reader();
const Reader& nanofocus_nms_reader();
const Reader& netcdf_reader();
const Reader& plux_reader();
const Reader& sdf_reader();
const Reader& sensofar_plu_reader();
const Reader& stylus_profile_reader();
const Reader& text_reader();
const Reader& tiff_reader();
const Reader& truemap_tmd_reader();
const Reader& wyko_ascii_reader();
const Reader& wyko_opd_reader();
const Reader& x3p_reader();
const Reader& zygo_dat_reader();
const Reader& zygo_datx_reader();
const Reader& zygo_xyz_reader();

}  // namespace manoscope::io
