"""Scenes of OpenUSD: .usd, .usda, .usdc and .usdz."""
