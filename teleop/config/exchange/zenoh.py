"""`type: zenoh` of a profile's `exchange`: the rig as one of several that an operator reaches together."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal, Self

from pydantic import Field, model_validator

from teleop.config.documents.base_model import Section
from teleop.config.exchange.endpoint import ConnectTo, ListenAt, endpoint

RIG_NAME = r"[A-Za-z0-9][A-Za-z0-9_.-]{0,39}"


class ZenohSection(Section):
    """The rig for `teleop fleet`, by Zenoh."""

    TRANSPORT: ClassVar = None

    type: Literal["zenoh"]
    """The rig for `teleop fleet`, by Zenoh."""
    name: Annotated[str, Field(pattern=f"^{RIG_NAME}$")]
    """What the rig is called among the others: letters, digits, `.`, `-` and `_`."""
    listen: ListenAt | None = None
    """Where operators connect: tls/HOST:PORT, or tcp/127.0.0.1:PORT for this computer alone."""
    connect: list[ConnectTo] = Field(default_factory=list, max_length=16)
    """Routers and other rigs to connect to."""
    credentials: str | None = None
    """File that `teleop fleet keys` has made for this rig: certificates, key and access list."""
    rate: Annotated[float, Field(ge=5, le=50)] = 20.0
    """States per second (Hz); with fewer than 5 a rig would count as lost between two of them."""

    @model_validator(mode="after")
    def _protected(self) -> Self:
        """Whoever reaches an endpoint without credentials operates the rig: so only this computer may."""
        if self.listen is None and not self.connect:
            raise ValueError("needs listen, connect or both")
        for key, text in [
            *([("listen", self.listen)] if self.listen else []),
            *(("connect", to) for to in self.connect),
        ]:
            found = endpoint(text)
            if found.protocol == "tls" and self.credentials is None:
                raise ValueError(f"{key} {text} needs credentials: make them with `teleop fleet keys`")
            if found.protocol == "tcp" and not found.is_loopback:
                needs = "" if self.credentials else " and credentials (`teleop fleet keys`)"
                raise ValueError(f"{key} {text} can be reached by others: use tls/{text[4:]}{needs}")
        return self
