#pragma once

#include "apps/capture/capture.h"
#include "apps/capture/catalogue.h"
#include "conetrace/lrsm/gather.h"

/// The buffers of the passes that make pictures, from "gbuffer" to "composite". What comes back has the very bits that went in.
namespace lrsm {

/// Does a specular cone look along a point of the lobe, and are those averaged over 4x4 pixels? As far as the scene has a specular part.
bool samplesLobes(const Settings& settings);
bool filtersLobes(const Settings& settings);

void describeGBuffer(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeDirect(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeCones(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeFilter(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeSpecularFilter(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeSmooth(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeComposite(Catalogue& out, const DescribedFrame& frame, std::size_t light);

// Fill in the bytes of those that are in the list; the others are left out.
void toBuffers(const GBuffer& gbuffer, std::vector<Buffer>& buffers);
void toBuffers(const Gathered& gathered, std::vector<Buffer>& buffers);
void toBuffers(const ConeRecord& cones, std::vector<Buffer>& buffers);
void toBuffers(const Image<Vec3>& picture, const std::string& name, std::vector<Buffer>& buffers);

// InputError naming the buffer that is not in the capture.
GBuffer gbufferFromCapture(const Capture& capture);
Gathered gatheredFromCapture(const Capture& capture);
Image<Vec3> pictureFromCapture(const Capture& capture, const std::string& name);
/// Has a frame by these settings the pass "filter"? Where its directions alternate over 4x4 pixels, and it is not turned off.
bool filtersIrradiance(const Settings& settings);
/// The irradiance of the 4x4 filter, or of the cones where it did not run.
Image<Vec3> filteredFromCapture(const Capture& capture);
/// The irradiance that the composite reads: that of the last filter that ran.
Image<Vec3> irradianceFromCapture(const Capture& capture);
/// The mean radiance over the specular lobe that the composite reads; empty without specular parts.
Image<Vec3> specularFromCapture(const Capture& capture);

}  // namespace lrsm
