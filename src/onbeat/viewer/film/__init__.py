"""What a film needs besides the dancer: scene, strip, flashes, planes of colour, coded sound."""
