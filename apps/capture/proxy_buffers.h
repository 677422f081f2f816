#pragma once

#include "apps/capture/capture.h"
#include "apps/capture/catalogue.h"
#include "conetrace/ism/gather.h"
#include "conetrace/proxies/gather.h"

/// The buffers of method=proxies and method=ism. How many there are of what is known only when it is made: until then buffers are described with the most that
/// can be, or none. What comes back has the very bits that went in.
namespace lrsm {

inline constexpr char kMarched[] = "pp.march", kFilteredLists[] = "pp.filter";  ///< first part of the names of a VisibilityLists' buffers
inline constexpr char kProxyHits[] = "pp.march_proxy_hits", kSeenLight[] = "pp.seen_light";

void describeProxies(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeProxyLight(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeProxyCells(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeMarched(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeFiltered(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeWeighed(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeListed(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeVirtualLights(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeImperfectMaps(Catalogue& out, const DescribedFrame& frame, std::size_t light);

/// Gives the buffers in the list the shapes of what was made.
void shapeBuffers(const PointProxies& proxies, std::vector<Buffer>& buffers);
void shapeBuffers(const ProxyLight& light, std::vector<Buffer>& buffers);
void shapeBuffers(const ProxyCells& cells, std::vector<Buffer>& buffers);
void shapeBuffers(const VisibilityLists& lists, const std::string& name, std::vector<Buffer>& buffers);
void shapeBuffers(const VirtualLights& lights, std::vector<Buffer>& buffers);
void shapeBuffers(const ImperfectMaps& maps, std::vector<Buffer>& buffers);

// Fill in the bytes of those that are in the list, in the shapes that they have: where less was made the rest is 0, where more it is left out.
void toBuffers(const PointProxies& proxies, std::vector<Buffer>& buffers);
void toBuffers(const ProxyLight& light, std::vector<Buffer>& buffers);
void toBuffers(const ProxyCells& cells, std::vector<Buffer>& buffers);
void toBuffers(const VisibilityLists& lists, const std::string& name, std::vector<Buffer>& buffers);
void toBuffers(const WeighedProxies& seen, std::vector<Buffer>& buffers);
void toBuffers(const VirtualLights& lights, std::vector<Buffer>& buffers);
void toBuffers(const ImperfectMaps& maps, std::vector<Buffer>& buffers);

// InputError naming the buffer that is not in the capture, or holds an index beyond what it counts.
PointProxies proxiesFromCapture(const Capture& capture);
ProxyLight proxyLightFromCapture(const Capture& capture);
ProxyCells proxyCellsFromCapture(const Capture& capture);
VisibilityLists listsFromCapture(const Capture& capture, const std::string& name, std::size_t cells);
WeighedProxies weighedFromCapture(const Capture& capture, const ProxyCells& cells);
VirtualLights virtualLightsFromCapture(const Capture& capture);
ImperfectMaps imperfectMapsFromCapture(const Capture& capture);

}  // namespace lrsm
