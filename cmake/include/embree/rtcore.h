// Embree 3 and Embree 4 with one face, that of 4: a query needs no context, and its rays are taken as they come. Never
// as "coherent" ones: with that flag a lane's hit depends on its neighbours.
#pragma once

#if LIGHTNET_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>

namespace lightnet_embree3 {
inline RTCIntersectContext any_rays() {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
}
}  // namespace lightnet_embree3

inline void rtcIntersect1(RTCScene scene, RTCRayHit* ray) {
    auto context = lightnet_embree3::any_rays();
    rtcIntersect1(scene, &context, ray);
}
inline void rtcOccluded1(RTCScene scene, RTCRay* ray) {
    auto context = lightnet_embree3::any_rays();
    rtcOccluded1(scene, &context, ray);
}
inline void rtcIntersect4(const int* valid, RTCScene scene, RTCRayHit4* rays) {
    auto context = lightnet_embree3::any_rays();
    rtcIntersect4(valid, scene, &context, rays);
}
inline void rtcOccluded4(const int* valid, RTCScene scene, RTCRay4* rays) {
    auto context = lightnet_embree3::any_rays();
    rtcOccluded4(valid, scene, &context, rays);
}
inline void rtcIntersect8(const int* valid, RTCScene scene, RTCRayHit8* rays) {
    auto context = lightnet_embree3::any_rays();
    rtcIntersect8(valid, scene, &context, rays);
}
inline void rtcOccluded8(const int* valid, RTCScene scene, RTCRay8* rays) {
    auto context = lightnet_embree3::any_rays();
    rtcOccluded8(valid, scene, &context, rays);
}
inline void rtcIntersect16(const int* valid, RTCScene scene, RTCRayHit16* rays) {
    auto context = lightnet_embree3::any_rays();
    rtcIntersect16(valid, scene, &context, rays);
}
inline void rtcOccluded16(const int* valid, RTCScene scene, RTCRay16* rays) {
    auto context = lightnet_embree3::any_rays();
    rtcOccluded16(valid, scene, &context, rays);
}
#endif
