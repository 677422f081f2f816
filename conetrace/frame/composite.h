#pragma once

#include "conetrace/frame/gbuffer.h"

namespace lrsm {

/// Radiance towards the eye, its indirect parts kept apart, W/(m^2 sr).
struct IndirectLight {
    Image<Vec3> diffuse;   ///< albedo * irradiance / pi
    Image<Vec3> specular;  ///< directional albedo of the lobe * mean radiance of the specular cone
};
IndirectLight shadeIndirect(const GBuffer& gbuffer, const Camera& camera, const Image<Vec3>& irradiance, const Image<Vec3>& specularRadiance);

/// direct + indirect diffuse + indirect specular.
Image<Vec3> composite(const Image<Vec3>& direct, const IndirectLight& indirect);

}  // namespace lrsm
