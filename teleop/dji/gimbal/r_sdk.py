"""All messages of the handheld gimbal's R SDK, in one registry."""

from __future__ import annotations

from teleop.dji.gimbal import camera, focus
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.registry import Registry, messages_of

R_SDK = Registry(
    sets={gimbal.GIMBAL: "gimbal", camera.CAMERA: "camera"},
    messages=(*messages_of(gimbal), *messages_of(focus), *messages_of(camera)),
    names={cls.set_and_id: cls.name for cls in (gimbal.Angles, gimbal.Push, gimbal.Version, camera.Command)},
)
