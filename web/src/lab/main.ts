import { createViewer } from '../viewer/viewer'

const place = document.querySelector<HTMLElement>('#lab')
if (place) createViewer(place)
